// Files that the program writes, read back; pages and pictures as text.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <regex>

#include "io/files.hpp"
#include "io/frames/dump.hpp"
#include "io/frames/gsd.hpp"
#include "io/frames/vtp.hpp"
#include "io/log.hpp"
#include "io/manifest.hpp"
#include "model/error.hpp"
#include "report/report.hpp"
#include "report/svg.hpp"
#include "support.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

// A directory of its own for every test.
class IoTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    dir_ =
        fs::temp_directory_path() / (std::string("ropewalk-io-") + test->name() + "-" + std::to_string(::getpid()));
    fs::create_directories(dir_);
  }
  void TearDown() override { fs::remove_all(dir_); }

  std::string path(const std::string& name) const { return (dir_ / name).string(); }
  std::string put(const std::string& name, const std::string& content) const {
    std::ofstream(path(name), std::ios::binary) << content;
    return path(name);
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : fs::directory_iterator(dir_)) all.push_back(entry.path().filename().string());
    return all;
  }

  fs::path dir_;
};

void expect_error(const std::function<void()>& f, int line, const std::string& words) {
  try {
    f();
    ADD_FAILURE() << "no error, \"" << words << "\" expected";
  } catch (const InputError& e) {
    EXPECT_EQ(e.place().line, line) << e.what();
    EXPECT_THAT(e.what(), HasSubstr(words));
    EXPECT_FALSE(e.place().file.empty());
    EXPECT_THAT(e.what(), HasSubstr("; ")) << "a remedy";
  }
}

std::uint64_t bits(double v) {
  std::uint64_t b;
  std::memcpy(&b, &v, sizeof b);
  return b;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

// Names what is not closed, or closed out of turn; empty where all is well.
std::string unbalanced(const std::string& markup) {
  std::vector<std::string> open;
  for (std::size_t at = markup.find('<'); at != std::string::npos; at = markup.find('<', at + 1)) {
    const std::size_t end = markup.find('>', at);
    if (end == std::string::npos) return "no >";
    const std::string tag = markup.substr(at + 1, end - at - 1);
    if (tag.empty() || tag.find('<') != std::string::npos) return "stray <: " + tag;
    if (tag[0] == '!' || tag[0] == '?' || tag.back() == '/') continue;
    const std::string name = tag.substr(tag[0] == '/' ? 1 : 0, tag.find_first_of(" \n") - (tag[0] == '/' ? 1 : 0));
    if (tag[0] != '/')
      open.push_back(name);
    else if (open.empty() || open.back() != name)
      return "</" + name + ">";
    else
      open.pop_back();
  }
  return open.empty() ? "" : "<" + open.back() + ">";
}

// --- Files ------------------------------------------------------------------------------------------------

TEST_F(IoTest, FilesAreReadBackByteForByte) {
  std::string content = "line\r\n";
  content += '\0';
  content += std::string(300000, '\xff');
  for (const std::string& c : {std::string(), content}) {
    write_file_atomically(path("a"), c);
    EXPECT_TRUE(read_file(path("a")) == c);
  }
  EXPECT_THAT(names(), testing::ElementsAre("a"));
}

TEST_F(IoTest, MissingFilesAndDirectoriesAreErrors) {
  expect_error([&] { read_file(path("none")); }, 0, "No such file");
  expect_error([&] { read_file(dir_.string()); }, 0, "directory");
  expect_error([&] { write_file_atomically(path("none/a"), "x"); }, 0, "No such file");
  put("file", "x");
  expect_error([&] { write_file_atomically(path("file/a"), "x"); }, 0, "Not a directory");
  fs::create_directory(path("folder"));
  expect_error([&] { write_file_atomically(path("folder"), "x"); }, 0, "directory");
  EXPECT_TRUE(fs::is_directory(path("folder")));
  EXPECT_THAT(names(), testing::UnorderedElementsAre("file", "folder")) << "no temporary file may stay";
}

// A write that the system refuses half-way, as on a full disk.
TEST_F(IoTest, FailedWriteLeavesTheOldFile) {
  put("a", "old");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{100000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string message;
  try {
    write_file_atomically(path("a"), std::string(1000000, 'x'));
  } catch (const InputError& e) {
    message = e.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_THAT(message, HasSubstr("cannot be written"));
  EXPECT_EQ(read_file(path("a")), "old");
  EXPECT_THAT(names(), testing::ElementsAre("a"));
}

TEST_F(IoTest, WritingKeepsThePermissionsOfTheFile) {
  put("a", "old");
  fs::permissions(path("a"), fs::perms(0640));
  write_file_atomically(path("a"), "new");
  EXPECT_EQ(fs::status(path("a")).permissions(), fs::perms(0640));
  EXPECT_EQ(read_file(path("a")), "new");
}

// Values of the reference implementation.
TEST(Hash, IsXxh64) {
  EXPECT_EQ(hash_hex(""), "ef46db3751d8e999");
  EXPECT_EQ(hash_hex("abc"), "44bc2cf5ad770999");
}

// --- Log --------------------------------------------------------------------------------------------------

LogRow full_row(unsigned seed) {
  test::Random random(seed);
  LogRow row;
  for (const Observable& c : observables())
    row[c.name] = c.whole ? std::floor(random.uniform(-1e6, 1e6))
                          : random.uniform(-1, 1) * std::pow(10, random.uniform(-300, 300));
  return row;
}

TEST_F(IoTest, LogIsReadBackBitForBit) {
  std::vector<LogRow> rows;
  for (unsigned k = 0; k < 50; ++k) rows.push_back(full_row(k));
  rows[1]["time_ps"] = 0.1;
  rows[2]["work_eV"] = -0.0;
  rows[3]["vdw_eV"] = std::numeric_limits<double>::denorm_min();
  rows[4]["vdw_eV"] = -std::numeric_limits<double>::infinity();
  rows[5]["step"] = 123456789012345.0;
  std::string text = log_header();
  for (const LogRow& row : rows) text += log_line(row);
  const std::vector<LogRow> read = read_log(put("log.csv", text));
  ASSERT_EQ(read.size(), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (const Observable& c : observables()) EXPECT_EQ(bits(read[k][c.name]), bits(rows[k][c.name])) << c.name;
}

TEST_F(IoTest, LogKeepsNan) {
  LogRow row;
  row["beta_deg"] = nan_value;
  EXPECT_TRUE(std::isnan(read_log(put("log.csv", log_header() + log_line(row)))[0]["beta_deg"]));
}

TEST_F(IoTest, LogIsShort) {
  LogRow row;
  row["step"] = 12;
  row["time_ps"] = 0.1;
  EXPECT_EQ(log_line(row).substr(0, 11), "12,0.1,0,0,");
  EXPECT_EQ(log_header().substr(0, 26), "step,time_ps,time_step_fs,");
  EXPECT_EQ(count_of(log_line(row), ","), observables().size() - 1);
}

TEST_F(IoTest, LogErrorsNameTheLine) {
  const std::string good = log_line(full_row(1)), header = log_header();
  const auto reading = [&](const std::string& text) { return [this, text] { read_log(put("log.csv", text)); }; };
  expect_error(reading(""), 1, "header");
  expect_error(reading(replaced(header, "time_ps", "time_fs") + good), 1, "\"time_fs\"");
  expect_error(reading(replaced(header, "\n", ",more\n") + good), 1, "more than");
  const std::string without_last = header.substr(0, header.rfind(','));
  const auto columns = std::count(header.begin(), header.end(), ',');
  const std::string without_two = without_last.substr(0, without_last.rfind(','));
  expect_error(reading(without_two + "\n" + good), 1, "ends after column " + std::to_string(columns - 1));
  // Logs of 0.3.0 lack the last column: they are read, and no row is added to them.
  EXPECT_EQ(read_log(put("log.csv", without_last + "\n" + good.substr(0, good.rfind(',')) + "\n")).size(), 1u);
  expect_error([&] { check_log_header(put("log.csv", without_last + "\n")); }, 1, "lacks columns");
  expect_error(reading(replaced(header, ",Q,", ",")), 1, "\"Q\" is needed");
  expect_error(reading(header + good + replaced(good, ",", "")), 3, "columns");
  expect_error(reading(header + good + good + replaced(good, ",", ",x")), 4, "time_ps");
  LogRow row;
  row["Q"] = 1.5;
  expect_error(reading(header + log_line(row)), 2, "not an integer");
  expect_error([&] { read_log(path("none.csv")); }, 0, "No such file");
  expect_error([&] { check_log_header(put("log.csv", "step\n")); }, 1, "ends after column 1");
  expect_error([&] { check_log_header(path("none.csv")); }, 0, "No such file");
  EXPECT_NO_THROW(check_log_header(put("log.csv", header)));
}

TEST_F(IoTest, LogLeavesOutALineThatIsCutOff) {
  const std::string good = log_line(full_row(1));
  EXPECT_EQ(read_log(put("log.csv", log_header() + good + good.substr(0, good.size() - 1))).size(), 1u);
  EXPECT_EQ(read_log(put("log.csv", log_header())).size(), 0u);
}

// --- Dump -------------------------------------------------------------------------------------------------

struct Frames {
  Topology topology = test::published_topology();
  State state;
  ElementColours colours;
};

// Three tubes of unequal length, one of a single element.
Frames some_frames(unsigned seed = 1) {
  Frames f;
  for (const int n : {4, 1, 3}) f.topology.add_tube(n);
  test::Random random(seed);
  f.state = State(8);
  for (std::size_t i = 0; i < 8; ++i) {
    f.state.position.set(i, random.uniform(0, 200) * random.direction());
    f.state.orientation.set(i, random.orientation());
    f.colours.bond_energy.push_back(random.uniform(0, 1));
    f.colours.vdw_energy.push_back(random.uniform(-1, 0));
    f.colours.bending_moment.push_back(random.uniform(0, 300));
    f.colours.twist_angle.push_back(random.uniform(-1, 1));
  }
  f.state.time = 12.625;
  f.state.step = 9007199254740993;  // not a double
  return f;
}

TEST_F(IoTest, DumpIsReadBackToItsPrintedPrecision) {
  const Frames one = some_frames(1), two = some_frames(2);
  DumpReader reader(put(
      "f", dump_frame(one.topology, one.state, one.colours) + dump_frame(two.topology, two.state, two.colours)));
  for (const Frames& f : {one, two}) {
    StoredFrame read;
    ASSERT_TRUE(reader.next(f.topology, read));
    EXPECT_EQ(read.state.step, f.state.step);
    EXPECT_EQ(read.state.time, f.state.time);
    ASSERT_EQ(read.state.size(), f.state.size());
    for (std::size_t i = 0; i < f.state.size(); ++i) {
      EXPECT_LT((read.state.position[i] - f.state.position[i]).cwiseAbs().maxCoeff(), 0.51e-7);
      EXPECT_LT((read.state.orientation[i].coeffs() - f.state.orientation[i].coeffs()).cwiseAbs().maxCoeff(), 3e-8);
      EXPECT_NEAR(read.state.orientation[i].norm(), 1, 1e-15);
      EXPECT_NEAR(read.colours.bond_energy[i], f.colours.bond_energy[i], 1e-6);
      EXPECT_NEAR(read.colours.vdw_energy[i], f.colours.vdw_energy[i], 1e-6);
      EXPECT_NEAR(read.colours.bending_moment[i], f.colours.bending_moment[i], 1e-3);
      EXPECT_NEAR(read.colours.twist_angle[i], f.colours.twist_angle[i], 1e-6);
      EXPECT_EQ(read.state.velocity[i].norm(), 0);
    }
  }
  StoredFrame none;
  EXPECT_FALSE(reader.next(one.topology, none));
  EXPECT_FALSE(reader.next(one.topology, none));
  ASSERT_EQ(reader.count(one.topology), 2u);
  for (const std::size_t k : {1, 0}) {
    reader.seek(k);
    ASSERT_TRUE(reader.next(one.topology, none));
    EXPECT_NEAR(none.state.position[0].x(), (k == 0 ? one : two).state.position[0].x(), 1e-6);
  }
}

TEST_F(IoTest, DumpHasTheColumnsThatOvitoKnows) {
  Frames f = some_frames();
  f.state.orientation.set(0, Quaternion(0.5, 0.1, 0.7, 0.5).normalized());
  const std::string text = dump_frame(f.topology, f.state, {});
  EXPECT_EQ(text.substr(0, 15), "ITEM: TIMESTEP\n");
  EXPECT_THAT(text, Not(HasSubstr("ITEM: TIME\n"))) << "MDAnalysis does not know it";
  EXPECT_THAT(text, HasSubstr("ITEM: BOX BOUNDS ff ff ff\n"));
  EXPECT_THAT(text, HasSubstr("ITEM: ATOMS id mol type x y z c_orient[1] c_orient[2] c_orient[3] c_orient[4] "
                              "c_shape[1] c_shape[2] c_shape[3] c_tube c_time_ps\n1 1 1 "));
  EXPECT_THAT(text, HasSubstr(" 0.10000000 0.70000000 0.50000000 0.50000000 0.678 0.678 1.356 1 12.625\n"))
      << "x, y, z, w";
  EXPECT_THAT(text, HasSubstr("\n5 2 1 "));
  EXPECT_THAT(text, Not(HasSubstr("shapex")));
  EXPECT_THAT(dump_frame(f.topology, f.state, f.colours),
              HasSubstr(" c_bond_energy_eV c_vdw_energy_eV c_bending_moment_eV c_twist_angle_rad\n"));
}

TEST_F(IoTest, DumpsOfVersion01AreStillRead) {
  const Frames f = some_frames();
  std::string old =
      replaced(dump_frame(f.topology, f.state, f.colours), "\nITEM: NUMBER", "\nITEM: TIME\n12.625\nITEM: NUMBER");
  for (const char* name : {"bond_energy_eV", "vdw_energy_eV", "bending_moment_eV", "twist_angle_rad"})
    old = replaced(old, std::string("c_") + name, name);
  old = replaced(old, "c_time_ps", "unknown");
  DumpReader reader(put("f", old));
  StoredFrame read;
  ASSERT_TRUE(reader.next(f.topology, read));
  EXPECT_EQ(read.state.time, 12.625);
  EXPECT_EQ(read.colours.vdw_energy.size(), f.state.size());
}

// Wherever a kill cuts the file, the frames before are read and nothing is thrown.
TEST_F(IoTest, DumpLeavesOutAFrameThatIsCutOff) {
  const Frames f = some_frames();
  const std::string one = dump_frame(f.topology, f.state, f.colours);
  for (std::size_t cut = 0; cut < one.size(); cut += 7) {
    DumpReader reader(put("f", one + one.substr(0, cut)));
    StoredFrame read;
    EXPECT_TRUE(reader.next(f.topology, read));
    EXPECT_FALSE(reader.next(f.topology, read)) << cut;
    EXPECT_EQ(read.state.step, f.state.step) << "left as it was";
    EXPECT_EQ(reader.count(f.topology), 1u) << cut;
  }
}

TEST_F(IoTest, DumpErrorsNameTheLine) {
  const Frames f = some_frames();
  const std::string one = dump_frame(f.topology, f.state, f.colours);
  const int lines = static_cast<int>(count_of(one, "\n"));
  const std::string last_row = one.substr(one.rfind('\n', one.size() - 2) + 1);
  const auto second = [&](const std::string& text, const Topology& topology) {
    return [this, text, one, &topology, &f] {
      DumpReader reader(put("f", one + text));
      StoredFrame read;
      reader.next(f.topology, read);
      reader.next(topology, read);
    };
  };
  const auto expect_second = [&](const std::string& text, int line, const std::string& words) {
    expect_error(second(text, f.topology), lines + line, words);
  };
  expect_second(one.substr(0, one.size() - last_row.size()) + one, lines, "truncated");
  expect_second(replaced(one, "ITEM: TIMESTEP", "ITEM: TIMES"), 1, "ITEM: TIMESTEP");
  expect_second(replaced(one, "9007199254740993", "9.5"), 2, "not a step");
  expect_second(replaced(one, " c_time_ps", " c_age"), 9, "c_time_ps");
  expect_second(replaced(one, " c_orient[3]", ""), 9, "c_orient[3]");
  expect_second(replaced(one, "\n3 1 1 ", "\n3 1 "), 12, "truncated");
  expect_second(replaced(one, "\n3 1 1 ", "\n3 1 1 1 "), 12, "more than");
  expect_second(replaced(one, "\n3 1 1 ", "\n3 1 1 x"), 12, "not a number");
  expect_second(replaced(one, "\n3 1 1 ", "\n3 2 1 "), 12, "tube");
  expect_second(replaced(one, "\n3 1 1 ", "\n2 1 1 "), 12, "twice");
  expect_second(replaced(one, "\n3 1 1 ", "\n9 1 1 "), 12, "no element");
  expect_second(std::regex_replace(one, std::regex("\n3 1 1 [^ ]+"), "\n3 1 1 nan"), 12, "not finite");
  expect_second(std::regex_replace(one, std::regex("( 0.678){2} 1.356 .*\n4 "), " 3\n4 "), 12, "truncated");
  Topology other = f.topology;
  other.add_tube(1);
  expect_error(second(one, other), lines + 4, "8 elements, the scene has 9");
  expect_error([&] { DumpReader(path("none")); }, 0, "cannot be opened");
}

TEST_F(IoTest, DumpRefusesAnOrientationThatIsNoRotation) {
  Frames f = some_frames();
  f.state.orientation.set(1, Quaternion(1, 1, 0, 0));
  DumpReader reader(put("f", dump_frame(f.topology, f.state, f.colours)));
  StoredFrame read;
  expect_error([&] { reader.next(f.topology, read); }, 11, "norm");
}

// --- GSD --------------------------------------------------------------------------------------------------

class Gsd : public IoTest {
 protected:
  // Writes the frames first .. last; their steps count from 1.
  void fill(GsdWriter& writer, int first, int last) {
    for (int k = first; k <= last; ++k) {
      f.state.step = k;
      f.state.time = 0.5 * k;
      f.state.position.set(0, {0, 0, 0.25 * k});
      writer.write(f.topology, f.state, f.colours);
    }
  }
  std::vector<long> steps(const std::string& file) const {
    GsdReader reader(path(file));
    std::vector<long> out;
    for (StoredFrame frame; reader.next(f.topology, frame);) {
      out.push_back(frame.state.step);
      EXPECT_EQ(frame.state.time, 0.5 * static_cast<double>(out.back()));
      EXPECT_EQ(frame.state.position[0].z(), 0.25 * static_cast<double>(out.back()));
    }
    return out;
  }
  static std::vector<long> up_to(long last) {
    std::vector<long> all;
    for (long k = 1; k <= last; ++k) all.push_back(k);
    return all;
  }

  Frames f = some_frames();
};

TEST_F(Gsd, IsReadBackInSinglePrecision) {
  GsdWriter(path("f"), 0, 1).write(f.topology, f.state, f.colours);
  ASSERT_TRUE(is_gsd(path("f")));
  const auto reader = open_frames(path("f"));
  StoredFrame read;
  ASSERT_TRUE(reader->next(f.topology, read));
  EXPECT_EQ(read.state.step, f.state.step);
  EXPECT_EQ(read.state.time, f.state.time);
  for (std::size_t i = 0; i < f.state.size(); ++i) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(read.state.position[i][k], static_cast<float>(f.state.position[i][k]));
    EXPECT_LT((read.state.orientation[i].coeffs() - f.state.orientation[i].coeffs()).cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_EQ(read.colours.bending_moment[i], static_cast<float>(f.colours.bending_moment[i]));
    EXPECT_EQ(read.colours.twist_angle[i], static_cast<float>(f.colours.twist_angle[i]));
  }
  EXPECT_FALSE(reader->next(f.topology, read));
}

// Beyond twice the frames that it was made for and some more, the index finds a new place, and finds back to an old
// one.
TEST_F(Gsd, TheIndexGrows) {
  GsdWriter writer(path("f"), 0, 0);
  fill(writer, 1, 50);
  const FileMark mark = writer.mark();
  fill(writer, 51, 300);
  EXPECT_EQ(steps("f"), up_to(300));
  GsdReader reader(path("f"));
  StoredFrame frame;
  for (const std::size_t k : {299, 7}) {
    reader.seek(k);
    ASSERT_TRUE(reader.next(f.topology, frame));
    EXPECT_EQ(frame.state.step, static_cast<long>(k + 1));
  }
  EXPECT_TRUE(reaches(path("f"), mark));
  EXPECT_TRUE(reaches(path("f"), writer.mark()));
  const FileMark late = writer.mark();
  fill(writer, 301, 310);
  GsdWriter(path("f"), late.bytes, 0);
  EXPECT_EQ(steps("f"), up_to(300));
  {
    GsdWriter again(path("f"), mark.bytes, 0);
    EXPECT_EQ(steps("f"), up_to(50));
    fill(again, 51, 200);
  }
  EXPECT_EQ(steps("f"), up_to(200));
  GsdWriter(path("f"), 0, 0);
  EXPECT_TRUE(steps("f").empty());
}

TEST_F(Gsd, GoesOnAsIfItHadNeverStopped) {
  {
    GsdWriter whole(path("whole"), 0, 10);
    fill(whole, 1, 8);
  }
  FileMark mark;
  {
    GsdWriter begun(path("f"), 0, 10);
    fill(begun, 1, 5);
    mark = begun.mark();
    fill(begun, 6, 7);
  }
  GsdWriter resumed(path("f"), mark.bytes, 10);
  fill(resumed, 6, 8);
  EXPECT_TRUE(read_file(path("f")) == read_file(path("whole")));
}

// Wherever a kill stops the writing: data first, then the entries.
TEST_F(Gsd, WhateverAKillLeavesIsAWholeFile) {
  std::string one, two;
  {
    GsdWriter writer(path("f"), 0, 1);
    fill(writer, 1, 1);
    one = read_file(path("f"));
    fill(writer, 2, 2);
    two = read_file(path("f"));
  }
  for (std::size_t cut = one.size(); cut <= two.size(); cut += 13) {
    put("f", one + two.substr(one.size(), cut - one.size()));
    EXPECT_EQ(steps("f"), up_to(1)) << cut;
    put("f", two.substr(0, std::min(cut, two.size() - 1)));
    EXPECT_EQ(steps("f"), up_to(1)) << cut;
  }
  GsdWriter(path("f"), one.size(), 1);
  EXPECT_TRUE(read_file(path("f")) == one) << "no entry of the lost frame stays";
}

TEST_F(Gsd, ErrorsNameTheChunk) {
  GsdWriter(path("f"), 0, 1).write(f.topology, f.state, f.colours);
  const std::string whole = read_file(path("f"));
  const auto refused = [&](const std::string& content, const Topology& topology, const std::string& words) {
    put("g", content);
    expect_error(
        [&] {
          StoredFrame read;
          GsdReader(path("g")).next(topology, read);
        },
        0, words);
  };
  Topology other = f.topology;
  other.add_tube(1);
  refused(whole, other, "particles/N: the frame has 8 elements, the scene has 9");
  Topology cut_elsewhere;
  cut_elsewhere.types = f.topology.types;
  cut_elsewhere.add_tube(1);
  cut_elsewhere.add_tube(f.topology.elements() - 1);
  refused(whole, cut_elsewhere, "particles/body: element 1 is of tube");
  refused(whole.substr(0, 100), f.topology, "the header is not whole");
  refused(whole.substr(0, 3000), f.topology, "ends before its index");
  refused(replaced(whole, "log/time_ps", "log/time_xx"), f.topology, "log/time_ps: is missing in frame 0");
  f.state.orientation.set(1, Quaternion(1, 1, 0, 0));
  GsdWriter(path("f"), 0, 1).write(f.topology, f.state, f.colours);
  refused(read_file(path("f")), f.topology, "that of element 1 in frame 0 has the norm");
  f.state.orientation.set(1, Quaternion(1, 0, 0, 0));
  f.state.position.set(2, {0, nan_value, 0});
  GsdWriter(path("f"), 0, 1).write(f.topology, f.state, f.colours);
  refused(read_file(path("f")), f.topology, "is not finite");
}

// --- VTK --------------------------------------------------------------------------------------------------

std::string decoded(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned group = 0, count = 0;
  for (const char c : base64) {
    if (c == '=') break;
    group = group << 6 | static_cast<unsigned>(digits.find(c));
    if (++count % 4 == 0) {
      for (const int shift : {16, 8, 0}) bytes += static_cast<char>(group >> shift & 255);
      group = 0;
    }
  }
  if (count % 4 == 2) bytes += static_cast<char>(group >> 4 & 255);
  if (count % 4 == 3) (bytes += static_cast<char>(group >> 10 & 255)) += static_cast<char>(group >> 2 & 255);
  return bytes;
}

template <class T>
std::vector<T> array_of(const std::string& vtp, const std::string& name, const std::string& after = "") {
  const std::size_t at = vtp.find("Name=\"" + name + "\"", after.empty() ? 0 : vtp.find(after));
  EXPECT_NE(at, std::string::npos) << name;
  const std::size_t begin = vtp.find('>', at) + 1;
  const std::string text = vtp.substr(begin, vtp.find('<', begin) - begin), bytes = decoded(text);
  EXPECT_EQ(text.size() % 4, 0u);
  std::uint64_t size = 0;
  std::memcpy(&size, bytes.data(), 8);
  EXPECT_EQ(bytes.size(), size + 8) << name;
  std::vector<T> values(size / sizeof(T));
  std::memcpy(values.data(), bytes.data() + 8, size);
  return values;
}

TEST(Vtp, HoldsPointsLinesAndColours) {
  const Frames f = some_frames();
  const std::string vtp = vtp_frame(f.topology, f.state, f.colours);
  EXPECT_EQ(unbalanced(vtp), "");
  EXPECT_THAT(vtp, HasSubstr("NumberOfPoints=\"8\" NumberOfVerts=\"1\" NumberOfLines=\"2\""));
  const auto points = array_of<float>(vtp, "points"), axis = array_of<float>(vtp, "axis"),
             director = array_of<float>(vtp, "director"), moment = array_of<float>(vtp, "bending_moment_eV");
  ASSERT_EQ(points.size(), 24u);
  ASSERT_EQ(director.size(), 24u);
  ASSERT_EQ(moment.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    const Frame frame = frame_of(f.state.orientation[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto c = static_cast<Eigen::Index>(k);
      EXPECT_EQ(points[3 * i + k], static_cast<float>(f.state.position[i][c]));
      EXPECT_NEAR(axis[3 * i + k], frame.t[c], 1e-7);
      EXPECT_NEAR(director[3 * i + k], frame.e1[c], 1e-7);
    }
    EXPECT_EQ(moment[i], static_cast<float>(f.colours.bending_moment[i]));
  }
  EXPECT_EQ(array_of<std::int32_t>(vtp, "connectivity", "<Lines>"),
            (std::vector<std::int32_t>{0, 1, 2, 3, 5, 6, 7}));
  EXPECT_EQ(array_of<std::int32_t>(vtp, "offsets", "<Lines>"), (std::vector<std::int32_t>{4, 7}));
  EXPECT_EQ(array_of<std::int32_t>(vtp, "connectivity", "<Verts>"), (std::vector<std::int32_t>{4}));
  EXPECT_EQ(array_of<std::int32_t>(vtp, "tube"), (std::vector<std::int32_t>{1, 1, 1, 1, 2, 3, 3, 3}));
}

TEST(Vtp, OmitsColoursThatAreNotGiven) {
  const Frames f = some_frames();
  EXPECT_THAT(vtp_frame(f.topology, f.state, {}), Not(HasSubstr("_eV")));
}

TEST(Pvd, ListsTheFrames) {
  const std::string pvd = pvd_text({{0, "a.vtp"}, {12.5, "b & c.vtp"}});
  EXPECT_EQ(unbalanced(pvd), "");
  EXPECT_THAT(pvd, HasSubstr("timestep=\"12.5\" part=\"0\" file=\"b &amp; c.vtp\""));
}

// --- Manifest ---------------------------------------------------------------------------------------------

Manifest some_manifest() {
  Manifest m;
  m.version = "0.1.0";
  m.git_id = "9857460";
  m.compiler = "GNU 12.2.0";
  m.build_type = "Release";
  m.threads = 2;
  m.seed = std::numeric_limits<std::uint64_t>::max();
  m.scene_hash = "ef46db3751d8e999";
  m.parameter_hash = "44bc2cf5ad770999";
  m.started = "2025-01-15T08:12:44Z";
  m.wall_seconds = 0.1;
  m.steps = 9007199254740993;
  m.time_step_fs = 1.0 / 3.0;
  m.status = "failed";
  m.reason = "step 3: a \"bond\" slipped\nβ";
  return m;
}

TEST_F(IoTest, ManifestIsReadBack) {
  const Manifest m = some_manifest();
  const Manifest read = read_manifest(put("m.json", manifest_json(m)));
  EXPECT_EQ(manifest_json(read), manifest_json(m));
  EXPECT_EQ(read.seed, m.seed);
  EXPECT_EQ(read.steps, m.steps);
  EXPECT_EQ(bits(read.time_step_fs), bits(m.time_step_fs));
  EXPECT_EQ(read.reason, m.reason);
  EXPECT_EQ(read.status, "failed");
  EXPECT_LT(manifest_json(m).find("\"version\""), manifest_json(m).find("\"git_id\""))
      << "in the order of the struct";
}

TEST_F(IoTest, ManifestErrors) {
  const std::string good = manifest_json(some_manifest());
  const auto reading = [&](const std::string& text) {
    return [this, text] { read_manifest(put("m.json", text)); };
  };
  expect_error(reading(replaced(good, "\"seed\": ", "\"seed\" ")), 13, "not JSON");
  expect_error(reading("[1]"), 0, "format");
  expect_error(reading("{\"format\": 3}"), 0, "format");
  expect_error(reading(replaced(good, "\"seed\"", "\"sed\"")), 0, "seed: is missing");
  expect_error(reading(replaced(good, "\"threads\": 2", "\"threads\": \"2\"")), 0, "threads");
  expect_error([&] { read_manifest(path("none")); }, 0, "No such file");
}

TEST(Manifest, TakesTextThatIsNotUtf8) {
  Manifest m = some_manifest();
  m.reason = "\xff";
  EXPECT_THAT(manifest_json(m), HasSubstr("reason"));
}

// --- Text and charts --------------------------------------------------------------------------------------

TEST(Text, IsEscaped) { EXPECT_EQ(escape_markup("<a href='x'>&\"\x01"), "&lt;a href=&#39;x&#39;&gt;&amp;&quot;?"); }

TEST(Text, NumbersAreReadable) {
  EXPECT_EQ(number_text(0), "0");
  EXPECT_EQ(number_text(-1.5), "−1.5");
  EXPECT_EQ(number_text(123456), "123\u202f456");
  EXPECT_EQ(number_text(1234.56), "1235");
  EXPECT_EQ(number_text(0.00012345, 3), "0.000123");
  EXPECT_EQ(number_text(-1.5e-7), "−1.5·10⁻⁷");
  EXPECT_EQ(number_text(2e12), "2·10¹²");
  EXPECT_EQ(number_text(nan_value), "–");
  EXPECT_EQ(fixed_text(-0.001, 2), "0.00");
  EXPECT_EQ(fixed_text(-12345.678, 1), "−12\u202f345.7");
}

TEST(Viridis, RunsFromVioletToYellow) {
  EXPECT_EQ(viridis(0), "#440154");
  EXPECT_EQ(viridis(1), "#fde725");
  EXPECT_EQ(viridis(7), "#fde725");
  EXPECT_EQ(viridis(nan_value), "#440154");
}

// Attribute values alone: text may hold any word.
std::string attributes(const std::string& markup) {
  std::string all;
  const std::regex value("=\"([^\"]*)\"");
  for (std::sregex_iterator m(markup.begin(), markup.end(), value), end; m != end; ++m) all += (*m)[1].str() + "\n";
  return all;
}

LineChart some_chart(std::size_t n, const std::function<double(double)>& f) {
  LineChart chart;
  chart.title = "A < B";
  chart.x = {"time", "ps"};
  chart.y = {"energy", "eV"};
  ChartLine line;
  line.name = "f & g";
  for (std::size_t i = 0; i < n; ++i) {
    line.x.push_back(static_cast<double>(i));
    line.y.push_back(f(static_cast<double>(i)));
  }
  chart.lines.push_back(line);
  return chart;
}

TEST(Chart, IsWellFormed) {
  const std::string svg = chart_svg(some_chart(10, [](double x) { return x * x; }));
  EXPECT_EQ(unbalanced(svg), "");
  EXPECT_THAT(svg, HasSubstr("time (ps)"));
  EXPECT_THAT(svg, HasSubstr("energy (eV)"));
  EXPECT_THAT(svg, HasSubstr("f &amp; g"));
  EXPECT_THAT(svg, HasSubstr("A &lt; B"));
}

TEST(Chart, ThinsCrowdedLinesButKeepsTheirPeaks) {
  LineChart chart = some_chart(100000, [](double x) { return x == 54321 ? 5.0 : 0.0; });
  const std::string crowded = chart_svg(chart);
  const std::size_t path = crowded.find("class=\"line");
  const std::string d = crowded.substr(path, crowded.find("/>", path) - path);
  EXPECT_LE(count_of(d, "L"), 400u);
  EXPECT_GE(count_of(d, "L"), 300u);
  chart.lines[0].y.assign(100000, 0.0);
  EXPECT_NE(chart_svg(chart), crowded);
  EXPECT_THAT(crowded, HasSubstr(">4<")) << "the axis reaches up to the peak";
}

TEST(Chart, DrawsGapsConstantsAndSpecks) {
  for (const auto& f : {std::function<double(double)>([](double x) { return x == 4 ? nan_value : x; }),
                        std::function<double(double)>([](double) { return 3.0; }),
                        std::function<double(double)>([](double) { return 0.0; }),
                        std::function<double(double)>([](double x) { return 1e-9 * x; }),
                        std::function<double(double)>([](double x) { return 1e12 + x; }),
                        std::function<double(double)>([](double x) { return x < 8 ? HUGE_VAL : -x; })}) {
    for (const bool whole : {false, true}) {
      LineChart chart = some_chart(10, f);
      chart.y.whole = whole;
      const std::string svg = chart_svg(chart);
      EXPECT_EQ(unbalanced(svg), "");
      EXPECT_THAT(attributes(svg), Not(testing::ContainsRegex("nan|inf|e[+-]")));
      EXPECT_LT(svg.size(), 6000u);
    }
  }
  const std::string gap = chart_svg(some_chart(10, [](double x) { return x == 4 ? nan_value : x; }));
  EXPECT_EQ(count_of(gap.substr(gap.find("class=\"line")), "M"), 4u) << "two stretches, the leader and the key";
}

TEST(Chart, CannotDrawWhatHasNoExtent) {
  EXPECT_EQ(chart_svg(LineChart()), "");
  EXPECT_EQ(chart_svg(some_chart(1, [](double x) { return x; })), "");
  EXPECT_EQ(chart_svg(some_chart(9, [](double) { return nan_value; })), "");
  EXPECT_EQ(chart_svg(some_chart(9, [](double x) { return x == 2 ? 1 : nan_value; })), "");
}

TEST(Chart, LabelsOfLinesKeepTheirDistance) {
  LineChart chart = some_chart(5, [](double x) { return x; });
  for (int k = 0; k < 7; ++k) chart.lines.push_back(chart.lines[0]);
  const std::string svg = chart_svg(chart);
  std::vector<double> at;
  const std::regex label("y=\"([0-9.]+)\">f &amp; g<");
  for (std::sregex_iterator m(svg.begin(), svg.end(), label), end; m != end; ++m) at.push_back(std::stod((*m)[1]));
  ASSERT_EQ(at.size(), 8u);
  for (std::size_t k = 1; k < at.size(); ++k) EXPECT_GE(at[k] - at[k - 1], 14.9);
  EXPECT_GE(at.front(), 0);
  EXPECT_LE(at.back(), chart.height);
}

TEST(Chart, TheSameDataGiveTheSameBytes) {
  const auto f = [](double x) { return std::sin(x); };
  EXPECT_EQ(chart_svg(some_chart(1000, f)), chart_svg(some_chart(1000, f)));
}

// --- Ropes and sections -----------------------------------------------------------------------------------

// Hexagonal rope of `shells` shells around the centre, twisted and bent.
RopeView twisted_rope(int shells, int elements, double twist, double amplitude, bool moments) {
  RopeView view;
  view.time_ps = 100 * twist;
  view.beta_deg = 30;
  for (int i = -shells; i <= shells; ++i)
    for (int j = -shells; j <= shells; ++j) {
      if (std::abs(i + j) > shells) continue;
      const double x = 1.713 * (i + 0.5 * j), y = 1.713 * 0.8660254 * j;
      std::vector<Vector3> tube;
      for (int e = 0; e < elements; ++e) {
        const double u = static_cast<double>(e) / elements, c = std::cos(6 * twist * u),
                     s = std::sin(6 * twist * u);
        tube.emplace_back(c * x - s * y + amplitude * std::sin(9 * u), s * x + c * y, 1.356 * e);
      }
      if (moments) view.colour.emplace_back(tube.size(), 10.0 + i);
      view.tubes.push_back(std::move(tube));
    }
  return view;
}

TEST(RopePicture, IsSmallAndWellFormed) {
  for (const bool moments : {false, true})
    for (const int elements : {2, 60, 400})
      for (const int shells : {0, 5, 9}) {
        const RopeView view = twisted_rope(shells, elements, 2, 10, moments);
        const RopeCamera camera = rope_camera({view}, 0.678);
        const std::string svg = rope_picture(view, camera, 0.678, "va", true);
        EXPECT_EQ(unbalanced(svg), "");
        EXPECT_LE(svg.size(), 60000u) << shells << " shells, " << elements << " elements";
        EXPECT_THAT(attributes(svg), Not(testing::ContainsRegex("nan|inf")));
        EXPECT_THAT(svg, HasSubstr("<path id=\"va"));
      }
}

TEST(RopePicture, ColoursByMomentOnlyWhereThereAreMoments) {
  const RopeView with = twisted_rope(2, 50, 1, 0, true), without = twisted_rope(2, 50, 1, 0, false);
  EXPECT_TRUE(rope_camera({with}, 0.678).coloured());
  EXPECT_FALSE(rope_camera({without}, 0.678).coloured());
  EXPECT_THAT(rope_svg(with, 0.678), HasSubstr("bending moment (nN nm)"));
  EXPECT_THAT(rope_svg(without, 0.678), Not(HasSubstr("bending moment")));
}

TEST(RopePicture, SurvivesWhatIsNotThere) {
  RopeView broken = twisted_rope(1, 20, 1, 0, true);
  broken.tubes[2][5] = Vector3(nan_value, 0, 0);
  broken.colour[3][7] = nan_value;
  broken.colour[4].clear();
  for (const RopeView& view : {RopeView(), broken}) {
    EXPECT_EQ(unbalanced(rope_svg(view, 0.678)), "");
    EXPECT_THAT(attributes(rope_svg(view, 0.678)), Not(testing::ContainsRegex("nan|inf")));
  }
}

TEST(RopePicture, HidesTheTubesInside) {
  RopeView front = twisted_rope(0, 30, 0, 0, false), both = front;
  const RopeCamera camera = rope_camera({twisted_rope(1, 30, 0, 0, false)}, 0.678);
  auto behind = front.tubes[0];
  for (Vector3& p : behind) p -= 3 * camera.towards;
  both.tubes.push_back(behind);
  const auto pieces = [&](const RopeView& view) {
    return count_of(rope_picture(view, camera, 0.678, "v", false), "<path id");
  };
  EXPECT_EQ(pieces(front), 1u);
  EXPECT_EQ(pieces(both), 1u);
}

TEST(RopePicture, DrawsTheLinksThatCanBeSeen) {
  RopeView view = twisted_rope(0, 30, 0, 0, false);
  const RopeCamera camera = rope_camera({twisted_rope(1, 30, 0, 0, false)}, 0.678);
  auto beside = view.tubes[0], before = view.tubes[0];
  for (Vector3& p : beside) p += 1.713 * camera.up;
  view.tubes.push_back(beside);
  const auto links = [&] {
    const std::string svg = rope_picture(view, camera, 0.678, "v", false);
    const std::size_t red = svg.find("#e0281e"), begin = svg.rfind("d=\"", red);
    return red == std::string::npos ? 0 : std::count(svg.begin() + begin, svg.begin() + red, 'M');
  };
  EXPECT_EQ(links(), 0);
  view.links = {{view.tubes[0][10], beside[10]},
                {view.tubes[0][15], beside[16]},
                {view.tubes[0][3], beside[28]},                                    // to an image in a slice
                {view.tubes[0][20], view.tubes[0][20] - 1.713 * camera.towards}};  // behind its tube
  EXPECT_EQ(links(), 2);
  for (Vector3& p : before) p += 1.713 * camera.towards + 0.8 * camera.up;
  view.tubes.push_back(before);
  EXPECT_EQ(links(), 0) << "a tube in front hides them";
}

TEST(RopeCamera, LooksAtTheRopeFromTheSide) {
  const RopeCamera c = rope_camera({twisted_rope(1, 100, 0, 0, false), twisted_rope(1, 100, 0, 20, false)}, 0.678);
  EXPECT_NEAR(c.right.z(), 1, 1e-6);
  EXPECT_NEAR(std::abs(c.up.x()), 1, 1e-3) << "bent along x";
  EXPECT_NEAR(c.right.cross(c.up).dot(c.towards), 1, 1e-12) << "no mirror image";
}

// A tube in the middle of six, five, seven or four others.
CrossSection around(int neighbours) {
  CrossSection s;
  s.points.emplace_back(0, 0);
  s.neighbours.push_back(neighbours);
  for (int k = 0; k < neighbours; ++k) {
    s.points.emplace_back(2 * std::cos(2 * units::pi * k / neighbours),
                          2 * std::sin(2 * units::pi * k / neighbours));
    s.neighbours.push_back(3);
  }
  s.charge = 6 - neighbours;
  return s;
}

RopeShells one_internal(std::size_t n) {
  RopeShells shells{std::vector<char>(n, 0), std::vector<char>(n, 1)};
  if (n > 0) shells.internal[0] = 1, shells.outermost[0] = 0;
  return shells;
}

TEST(SectionPicture, ColoursTubesByTheirNeighbours) {
  for (const auto& [n, name] : {std::pair(5, "n5"), std::pair(6, "n6"), std::pair(7, "n7"), std::pair(4, "nx")}) {
    const std::string svg = section_picture(around(n), one_internal(1 + n), 0.678, 3);
    EXPECT_EQ(unbalanced(svg), "");
    EXPECT_EQ(count_of(svg, "<circle class=\"" + std::string(name) + "\""), 1u);
    EXPECT_EQ(count_of(svg, "<circle class=\"outermost\""), static_cast<std::size_t>(n));
  }
}

// --- Report -----------------------------------------------------------------------------------------------

ReportInput some_report(std::size_t rows) {
  ReportInput in;
  in.rope = true;
  in.name = "rope <91> & more";
  in.status = "finished";
  in.facts = {{"Scene", "a.toml", "x < y"}, {"Took", "3 s", ""}};
  in.warnings = {"beware of <b>"};
  for (std::size_t k = 0; k < rows; ++k) {
    LogRow r = full_row(static_cast<unsigned>(k));
    for (const Observable& c : observables())
      if (!c.whole) r[c.name] = std::sin(static_cast<double>(k) * 0.1);
    r["time_ps"] = static_cast<double>(k);
    r["Q"] = -2;
    r["kinked"] = k == 3 ? 5 : 2;
    r["overtwisted"] = r["overstretched"] = 0;
    in.log.push_back(r);
  }
  in.ramp_end_ps = 30;
  in.tube_radius = 0.678;
  in.element_length = 1.356;
  in.tubes = 8;
  in.bonds = 1000;
  in.validity = {0.087, 0.05, 0.07};
  in.shells = one_internal(8);
  for (const int n : {6, 5, 7}) {
    ReportSection s;
    s.time_ps = n;
    s.section = around(n);
    s.radius_profile = {1, 2, 3, 2.0 + n};
    in.sections.push_back(s);
    in.views.push_back(twisted_rope(2, 40, 0.1 * n, 0, n == 7));
  }
  in.parameter_name = "set";
  in.parameters = {{"bond.EI", 358.4, "nN nm^2", std::nullopt, "derived", "10.1016/j.jmps.2012.10.016", ""},
                   {"contact.paper.C3", -0.00138, "1", 2e-5, "published", "", ""}};
  return in;
}

void expect_sound_page(const std::string& html) {
  EXPECT_EQ(unbalanced(html), "");
  for (const char* reference : {"http://", "https://", " src=", "url(", "<script", "@import", "<link", "<img"})
    EXPECT_THAT(html, Not(HasSubstr(reference)));
  const std::regex href("href=\"([^#])");
  EXPECT_FALSE(std::regex_search(html, href)) << "only references into the page itself";
  EXPECT_THAT(
      html,
      HasSubstr(
          "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src "
          "'unsafe-inline'\"/>"));
  EXPECT_THAT(attributes(html), Not(testing::ContainsRegex("[^a-z]nan|[^a-z]inf")));
  EXPECT_THAT(html, Not(testing::ContainsRegex("[>( ]-?nan[ <)]")));
}

TEST(Report, IsOneSoundPage) {
  const std::string html = report_html(some_report(500));
  expect_sound_page(html);
  EXPECT_THAT(html, HasSubstr("<h1>rope &lt;91&gt; &amp; more</h1>"));
  EXPECT_THAT(html, HasSubstr("beware of &lt;b&gt;"));
  EXPECT_THAT(html, HasSubstr("The run finished as planned."));
  EXPECT_THAT(html, HasSubstr("circle class=\"n5\""));
  EXPECT_THAT(html, HasSubstr("circle class=\"n7\""));
  EXPECT_THAT(html, HasSubstr("<b>Q = −1</b>"));
  EXPECT_THAT(html, HasSubstr("bending moment (nN nm)"));
  EXPECT_THAT(html, HasSubstr("class=\"load\""));
  EXPECT_THAT(html, HasSubstr("class=\"hold\""));
  EXPECT_THAT(html, HasSubstr("60 of 500 rows"));
  EXPECT_THAT(html, HasSubstr("2 of 1000 bonds at the end (0.2 %); most at 3 ps: 5"));
  EXPECT_THAT(html, HasSubstr("none of 1000 bonds"));
  EXPECT_THAT(html, HasSubstr("not published"));
  EXPECT_THAT(html, HasSubstr("10.1016/j.jmps.2012.10.016"));
  EXPECT_THAT(html, HasSubstr("nN nm²"));
  EXPECT_THAT(html, HasSubstr("−0.00138"));
}

TEST(Report, NumbersItsFiguresInTheOrderOfThePage) {
  const std::string html = report_html(some_report(50));
  std::size_t at = 0;
  for (int k = 1; k <= 12; ++k) {
    const std::size_t next = html.find("<b>Figure " + std::to_string(k) + ".</b>");
    ASSERT_NE(next, std::string::npos) << k;
    EXPECT_GT(next, at);
    at = next;
  }
}

TEST(Report, ListsEveryObservable) {
  ReportInput in = some_report(50);
  in.log[3]["radius_mid_nm"] = 7777;
  in.log[4]["radius_mid_nm"] = nan_value;
  const std::string html = report_html(in);
  const std::string none = "Zero, or without a value, in all rows: ";
  const std::size_t zero = html.find(none), last = html.find(".</p>", zero);
  ASSERT_NE(zero, std::string::npos);
  EXPECT_EQ(html.substr(zero + none.size(), last - zero - none.size()), "overtwisted, overstretched");
  for (const Observable& o : observables())
    EXPECT_EQ(html.find("<tr><th>" + o.name + "</th>") == std::string::npos,
              o.name == "overtwisted" || o.name == "overstretched")
        << o.name;
  const std::size_t row = html.find("<th>kinked</th>"), end = html.find("</tr>", row);
  EXPECT_THAT(html.substr(row, end - row),
              HasSubstr("<td class=\"number\">2</td><td class=\"number\">2</td><td class=\"number\">2</td><td "
                        "class=\"number\">5</td>"))
      << "start, end, smallest, largest";
  EXPECT_THAT(html, HasSubstr("7777</td>"));
}

TEST(Report, IdsAreUnique) {
  const std::string html = report_html(some_report(50));
  std::vector<std::string> ids;
  const std::regex id(" id=\"([^\"]*)\"");
  for (std::sregex_iterator m(html.begin(), html.end(), id), end; m != end; ++m) ids.push_back((*m)[1]);
  std::sort(ids.begin(), ids.end());
  EXPECT_GT(ids.size(), 3u);
  EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end());
}

TEST(Report, EmptyAndShortLogs) {
  const std::string none = report_html(some_report(0)), one = report_html(some_report(1));
  expect_sound_page(none);
  expect_sound_page(one);
  EXPECT_THAT(none, HasSubstr("no rows"));
  EXPECT_THAT(one, HasSubstr("one row"));
  expect_sound_page(report_html(some_report(2)));
  expect_sound_page(report_html(ReportInput()));
}

TEST(Report, ValuesThatAreNotNumbers) {
  ReportInput in = some_report(40);
  for (LogRow& r : in.log) {
    r["beta_deg"] = nan_value;
    r["Q"] = r["Q_delaunay"] = nan_value;
    r["amplitude_nm"] = std::numeric_limits<double>::infinity();
  }
  in.log[7]["twist_eV"] = nan_value;
  in.log[0]["vdw_eV"] = nan_value;
  in.log[39]["kinked"] = nan_value;
  in.views[0].tubes[0][0].x() = nan_value;
  in.sections[1].section.points[2].x() = nan_value;
  in.sections[0].radius_profile[1] = nan_value;
  in.sections[2].beta_deg = nan_value;
  const std::string html = report_html(in);
  expect_sound_page(html);
  EXPECT_THAT(html, HasSubstr("Not drawn"));
}

TEST(Report, NamesChartsThatWouldShowZero) {
  ReportInput in = some_report(40);
  for (LogRow& r : in.log) r["Q"] = r["Q_delaunay"] = r["windings"] = 0;
  const std::string html = report_html(in);
  EXPECT_THAT(html, HasSubstr("Zero at all times: Packing charge, Windings of the centre line."));
  EXPECT_THAT(html, Not(HasSubstr("Packing charge</h3>")));
  in.log[20]["Q"] = -1;
  EXPECT_THAT(report_html(in), HasSubstr("Packing charge</h3>"));
}

TEST(Report, ASingleTubeHasNoPackingCharge) {
  ReportInput in = some_report(40);
  in.tubes = 1;
  in.rope = false;
  in.shells = RopeShells{{0}, {1}};
  in.sections.clear();
  in.views = {twisted_rope(0, 30, 0, 1, false)};
  const std::string html = report_html(in);
  expect_sound_page(html);
  EXPECT_THAT(html, Not(HasSubstr("Packing charge</h3>")));
  EXPECT_THAT(html, Not(HasSubstr("Cross-sections")));
  EXPECT_THAT(html, Not(HasSubstr("β =")));
  EXPECT_THAT(html, HasSubstr("<h2>The tube</h2>"));
}

TEST(Report, ARelaxationIsDrawnOverItsSteps) {
  ReportInput in = some_report(40);
  for (std::size_t k = 0; k < in.log.size(); ++k) {
    in.log[k]["time_ps"] = 0;
    in.log[k]["step"] = 100.0 * static_cast<double>(k);
  }
  in.ramp_end_ps = 0;
  in.reason = "relaxed: largest force below 0.0001 eV/nm";
  const std::string html = report_html(in);
  expect_sound_page(html);
  EXPECT_THAT(html, HasSubstr(">step</text>"));
  EXPECT_THAT(html, HasSubstr("After 3900 steps"));
  EXPECT_THAT(html, HasSubstr("most at step 300"));
  EXPECT_THAT(html, HasSubstr("The run finished: relaxed: largest force below 0.0001 eV/nm."));
}

TEST(Report, SaysHowTheRunEnded) {
  ReportInput in = some_report(5);
  const auto page = [&](const char* status, const char* reason) {
    in.status = status;
    in.reason = reason;
    return report_html(in);
  };
  EXPECT_THAT(page("failed", "step 7: <slip>"), HasSubstr("The run failed: step 7: &lt;slip&gt;."));
  EXPECT_THAT(page("interrupted", ""), HasSubstr("The run was interrupted."));
  EXPECT_THAT(page("running", ""), HasSubstr("had not ended"));
  EXPECT_THAT(page("", ""), HasSubstr("is not known"));
}

TEST(Report, ShowsSixOfManyTimes) {
  ReportInput in = some_report(20);
  while (in.sections.size() < 30) {
    in.sections.push_back(in.sections[0]);
    in.views.push_back(in.views[0]);
  }
  const std::string html = report_html(in);
  EXPECT_EQ(count_of(html, "class=\"view\""), 6u);
  EXPECT_EQ(count_of(html, "class=\"cut\""), 6u);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
