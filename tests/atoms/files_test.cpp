// Files of atoms as LAMMPS, ASE and others write them, and files that are damaged.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "atoms/atom_files.hpp"
#include "atoms/atom_writer.hpp"
#include "atoms/support.hpp"
#include "model/error.hpp"

namespace ropewalk {
namespace {
namespace UNIT {

using namespace test;
namespace fs = std::filesystem;

class AtomFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / fmt::format("ropewalk-atoms-{}", getpid());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  static AtomFrame first(const std::vector<std::string>& paths) {
    AtomFiles files(paths, 2);
    AtomFrame frame;
    files.next(frame);
    return frame;
  }
  static std::string refusal(const std::vector<std::string>& paths) {
    try {
      first(paths);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  fs::path folder_;
};

TEST_F(AtomFile, DumpIsSortedScaledAndTilted) {
  const std::string dump = file("a.lammpstrj",
                                "ITEM: TIMESTEP\n500\nITEM: NUMBER OF ATOMS\n3\n"
                                "ITEM: BOX BOUNDS xy xz yz pp ff pp\n0 25 5\n0 10 0\n0 30 0\n"
                                "ITEM: ATOMS id type element xs ys zs vx vy vz\n"
                                "7 2 H 0.5 0.5 0.5 0 0 1\n2 1 C 0.25 0 0.1 1 0 0\n5 1 C 0 1 0 0 2 0\n");
  const AtomFrame frame = first({dump});
  ASSERT_EQ(frame.positions.size(), 3u);
  EXPECT_NEAR(frame.time, 1.0, 1e-12) << "500 steps of 2 fs";
  EXPECT_TRUE(frame.box.periodic[0] && !frame.box.periodic[1] && frame.box.periodic[2]);
  EXPECT_NEAR((frame.box.edges.col(0) - Vector3(2, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((frame.box.edges.col(1) - Vector3(0.5, 1, 0)).norm(), 0, 1e-12);
  // In the order of their ids: 2, 5, 7.
  EXPECT_NEAR((frame.positions[0] - Vector3(0.5, 0, 0.3)).norm(), 0, 1e-12);
  EXPECT_NEAR((frame.positions[1] - Vector3(0.5, 1, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((frame.positions[2] - Vector3(1.25, 0.5, 1.5)).norm(), 0, 1e-12);
  EXPECT_EQ(frame.species, (std::vector<char>{1, 1, 0}));
  EXPECT_NEAR((frame.velocities[1] - Vector3(0, 0.2, 0)).norm(), 0, 1e-12);
}

TEST_F(AtomFile, DataFileTellsTheSpeciesOfADump) {
  const std::string data =
      file("a.data",
           "title\n\n2 atoms\n2 atom types\n\n0 10 xlo xhi\n0 10 ylo yhi\n0 10 zlo zhi\n\n"
           "Masses\n\n1 1.008\n2 12.011 # C\n\nAtoms # full\n\n1 1 2 0.0 1 2 3\n2 1 1 0.0 4 5 6\n");
  const std::string dump =
      file("a.dump",
           "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 10\n0 10\n0 "
           "10\nITEM: ATOMS id type x y z\n2 1 4 5 6\n1 2 1 2 3\n");
  EXPECT_EQ(first({data}).species, (std::vector<char>{1, 0}));
  EXPECT_EQ(first({dump, data}).species, (std::vector<char>{1, 0}));
  EXPECT_NEAR((first({data}).positions[1] - Vector3(0.4, 0.5, 0.6)).norm(), 0, 1e-12);
  EXPECT_NE(refusal({dump}).find("no known species"), std::string::npos);
}

TEST_F(AtomFile, ExtendedXyzHasABoxTimeAndColumnsOfItsOwn) {
  const std::string xyz =
      file("a.xyz",
           "2\nLattice=\"10 0 0 2 10 0 0 0 20\" Properties=tag:I:1:species:S:1:pos:R:3 pbc=\"T F T\" "
           "Time=3.5\n4 C 1 2 3\n5 O 4 5 6\n");
  const AtomFrame frame = first({xyz});
  EXPECT_NEAR(frame.time, 3.5, 1e-12);
  EXPECT_NEAR((frame.box.edges.col(1) - Vector3(0.2, 1, 0)).norm(), 0, 1e-12);
  EXPECT_FALSE(frame.box.periodic[1]);
  EXPECT_EQ(frame.species, (std::vector<char>{1, 0}));
  EXPECT_NEAR((frame.positions[1] - Vector3(0.4, 0.5, 0.6)).norm(), 0, 1e-12);
}

TEST_F(AtomFile, LeavesOutAFrameThatIsCutOff) {
  const std::string frame = "2\ncomment\nC 0 0 0\nC 1 1 1\n";
  AtomFiles files({file("a.xyz", frame + frame + "2\ncomment\nC 0 0 0\n")}, 1);
  AtomFrame read;
  EXPECT_TRUE(files.next(read));
  EXPECT_TRUE(files.next(read));
  EXPECT_FALSE(files.next(read));
  EXPECT_TRUE(files.cut_off());
  EXPECT_NE(refusal({file("b.xyz", "2\ncomment\nC 0 0 0\n")}).find("ends within its first frame"),
            std::string::npos);
}

// Also within its last number, which would stand for another place: LAMMPS ends each line.
TEST_F(AtomFile, LeavesOutADumpThatIsCutOffAnywhere) {
  const std::string frame =
      "ITEM: TIMESTEP\n7\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n"
      "ITEM: ATOMS id element x y z\n1 C 0 0 1\n2 C 0 0 2.5\n";
  std::string later = frame;
  later[later.find('7')] = '8';
  for (std::size_t length = 0; length <= later.size(); ++length) {
    AtomFiles files({file("a.dump", frame + later.substr(0, length))}, 1);
    AtomFrame read;
    std::size_t frames = 0;
    try {
      while (files.next(read)) ++frames;
    } catch (const InputError&) {  // a head that is cut off is named
    }
    EXPECT_EQ(frames, length < later.size() ? 1U : 2U) << length;
  }
}

// A simulation that goes on writes the frame at which it was stopped once more.
TEST_F(AtomFile, LeavesOutTheFrameAtWhichASecondFileGoesOn) {
  const auto dump = [](int step, double z) {
    return fmt::format("ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n"
                       "ITEM: ATOMS id element x y z\n1 C 0 0 {}\n",
                       step, z);
  };
  AtomFiles dumps({file("a.dump", dump(0, 1) + dump(10, 2)), file("b.dump", dump(10, 2) + dump(20, 3))}, 1);
  AtomFrame read;
  std::vector<long> heights;  // Angstrom
  while (dumps.next(read)) heights.push_back(std::lround(10 * read.positions[0].z()));
  EXPECT_EQ(heights, (std::vector<long>{1, 2, 3}));
  // Frames that state no time are 1 ps apart, also from one file to the next.
  const std::string frame = "1\ncomment\nC 0 0 0\n";
  AtomFiles untimed({file("a.xyz", frame + frame), file("b.xyz", frame + frame)}, 1);
  std::vector<double> times;
  while (untimed.next(read)) times.push_back(read.time);
  EXPECT_EQ(times, (std::vector<double>{0, 1, 2, 3}));
}

TEST_F(AtomFile, DamagedFilesNameTheLine) {
  EXPECT_NE(refusal({file("a.xyz", "2\ncomment\nC 0 0 0\nC 1 x 1\n")}).find("a.xyz:4: pos: \"x\" is not a number"),
            std::string::npos);
  EXPECT_NE(refusal({file("a.pdb", "ATOM 1\n")}).find("no file of atoms"), std::string::npos);
  const std::string head =
      "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n";
  EXPECT_NE(refusal({file("b.dump", head + "ITEM: ATOMS type x y z\n1 0 0 0\n1 1 1 1\n")}).find("no column id"),
            std::string::npos);
  EXPECT_NE(
      refusal({file("c.dump", head + "ITEM: ATOMS id type x y z\n1 1 0 0 0\n1 1 1 1 1\n")}).find("comes twice"),
      std::string::npos);
  EXPECT_NE(refusal({file("d.data",
                          "t\n\n2 atoms\n1 atom types\n0 9 xlo xhi\n0 9 ylo yhi\n0 9 zlo zhi\n\nAtoms # "
                          "atomic\n\n1 1 0 0 0\n")})
                .find("ends within Atoms"),
            std::string::npos);
}

// What `atoms` writes is read again, in both formats: same places to the digits of the file.
TEST_F(AtomFile, ReadsWhatIsWritten) {
  const ParameterSet set = shipped("cnt-5-5-tersoff");
  const Elements e = rod(4, set.element_length, {0, 0.05, 0.1});
  const AtomsOfElements atoms(e.topology, e.state, {reference_of(set)}, {{0, 0, 4}});
  const std::vector<Vector3> placed = test::atoms_of(e, reference_of(set));
  for (const char* name : {"a.data", "a.xyz"}) {
    const std::string path = (folder_ / name).string();
    const std::vector<AtomRange> ranges = write_atoms(path, atom_format_of(path), atoms, "four & elements", 2.5);
    ASSERT_EQ(ranges.size(), 4u);
    EXPECT_EQ(ranges.back().last, static_cast<long>(placed.size()));
    const AtomFrame frame = first({path});
    ASSERT_EQ(frame.positions.size(), placed.size());
    double off = 0;
    for (std::size_t i = 0; i < placed.size(); ++i) off = std::max(off, (frame.positions[i] - placed[i]).norm());
    EXPECT_LT(off, 2e-8);
  }
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk
