// The files of an export, where no LAMMPS is needed.
#include "scene/lammps_files.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "model/error.hpp"
#include "scene/lammps_states.hpp"
#include "scene/scene_toml.hpp"
#include "scene/templates.hpp"
#include "unit/support.hpp"

namespace ropewalk::test {
namespace {
namespace UNIT {

class LammpsFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    dir.path = (std::filesystem::temp_directory_path() /
                ("ropewalk-" + std::string(info->name()) + "-" + std::to_string(getpid())))
                   .string();
    std::filesystem::create_directories(dir.path);
  }
  void TearDown() override { std::filesystem::remove_all(dir.path); }

  static void spit(const std::string& path, const std::string& text) { std::ofstream(path) << text; }
  static Topology two_types() {
    Topology t = published_topology();
    t.types.push_back(t.types[0]);
    return t;
  }

  LammpsDirectory dir;
};

// docs/tutorials/cluster.md has these in a table.
TEST_F(LammpsFiles, OneKindOfScenesIsNotForLammps) {
  const std::map<std::string, std::string> refused = {
      {"yarn", "periodic.tension_nN: is not for LAMMPS: the period then moves by the forces on all images"}};
  std::size_t met = 0;
  for (const SceneTemplate& kind : scene_templates()) {
    SCOPED_TRACE(kind.name);
    const std::string path = dir.path + "/" + kind.name + ".toml";
    spit(path, kind.text);
    const auto found = refused.find(kind.name);
    std::string told;
    try {
      refuse_what_lammps_lacks(read_scene(path));
    } catch (const InputError& e) {
      told = e.what();
    }
    met += found != refused.end();
    if (found == refused.end())
      EXPECT_EQ(told, "");
    else
      EXPECT_NE(told.find(found->second), std::string::npos) << told;
  }
  EXPECT_EQ(met, refused.size());
}

TEST_F(LammpsFiles, TubesAreCountedInRows) {
  Topology t = two_types();
  for (int k = 0; k < 5; ++k) t.add_tube(7, 0);
  t.add_tube(7, 1);
  t.add_tube(9, 1);
  t.add_tube(7, 0);
  const std::string text = tubes_csv(t);
  EXPECT_EQ(text, "tubes,elements,type\n5,7,0\n1,7,1\n1,9,1\n1,7,0\n");
  spit(dir.tubes(), text);
  Topology back = two_types();
  read_tubes(dir, back);
  EXPECT_EQ(back.tube_begin, t.tube_begin);
  EXPECT_EQ(back.tube_type, t.tube_type);
}

TEST_F(LammpsFiles, WrongTubesAreRefused) {
  for (const char* text :
       {"", "5,7,0\n", "tubes,elements,type\n", "tubes,elements,type\n5,7\n", "tubes,elements,type\n5,7,2\n",
        "tubes,elements,type\n2000000000,2000000000,0\n", "tubes,elements,type\n0,7,0\n",
        "tubes,elements,type\n5,7,0,1\n", "tubes,elements,type\nx,7,0\n"}) {
    spit(dir.tubes(), text);
    Topology t = two_types();
    EXPECT_THROW(read_tubes(dir, t), InputError) << text;
  }
}

TEST_F(LammpsFiles, StartKeepsItsBits) {
  LammpsStart s;
  s.id = 0xfedcba9876543210;
  s.step = 123456789012;
  s.time = 0.1 + 0.2;
  s.time_step = 1.0 / 3;
  s.work = -1e-300;
  s.dissipated = 5e22;
  s.viscosity_inner = 1.7129407435690116;
  s.viscosity_outer = 2.5694111153535175;
  s.parameters = {"parameters.toml", "parameters-1.toml"};
  spit(dir.start(), start_json(s));
  const LammpsStart back = read_start(dir);
  EXPECT_EQ(back.id, s.id);
  EXPECT_EQ(back.step, s.step);
  EXPECT_EQ(back.time, s.time);
  EXPECT_EQ(back.time_step, s.time_step);
  EXPECT_EQ(back.work, s.work);
  EXPECT_EQ(back.dissipated, s.dissipated);
  EXPECT_EQ(back.viscosity_inner, s.viscosity_inner);
  EXPECT_EQ(back.viscosity_outer, s.viscosity_outer);
  EXPECT_EQ(back.parameters, s.parameters);
  spit(dir.start(), "{\"format\": \"something else\"}");
  EXPECT_THROW(read_start(dir), InputError);
  spit(dir.start(), "{\"format\": \"ropewalk-lammps-3\"}");
  EXPECT_THROW(read_start(dir), InputError);
}

class LammpsStateFiles : public LammpsFiles {
 protected:
  LammpsStateFiles() : topology(published_topology()), state(2), force(2), torque(2) {
    topology.add_tube(2);
    header.step = 5;
    header.elements = 2;
    header.time = 0.1 + 0.2;
    for (std::size_t i = 0; i < 2; ++i) {
      state.position.set(i, {0.1, 0.2, 0.3 + static_cast<double>(i)});
      state.orientation.set(i, Quaternion(0, 0, 0, 1));
      state.angular_velocity.set(i, {12, 13, 14});
      torque.set(i, {18, 19, 1e-300});
    }
  }
  std::string bytes() const { return state_file(header, state, force, torque); }
  // The number of states.
  std::size_t read(const std::string& text) {
    spit(dir.states(), text);
    LammpsStates states(dir.states(), topology);
    std::size_t n = 0;
    while (states.next(found, force, torque)) ++n;
    return n;
  }

  Topology topology;
  State state, found;
  Vec3Array force, torque;
  StateHeader header;
};

TEST_F(LammpsStateFiles, KeepTheirBits) {
  ASSERT_EQ(read(bytes()), 1U);
  EXPECT_EQ(found.step, 5);
  EXPECT_EQ(found.time, 0.1 + 0.2);
  EXPECT_EQ(found.position[1], Vector3(0.1, 0.2, 1.3));
  EXPECT_EQ(found.orientation[1].z(), 1);
  EXPECT_EQ(found.angular_velocity[1], Vector3(12, 13, 14));
  EXPECT_EQ(torque[1], Vector3(18, 19, 1e-300));
}

TEST_F(LammpsStateFiles, WhatIsNotWholeDoesNotCount) {
  const std::string one = bytes();
  EXPECT_EQ(read(one + one + one), 3U);
  EXPECT_EQ(read(one + one.substr(0, one.size() - 1)), 1U);
  EXPECT_EQ(read(one + one.substr(0, 63)), 1U);
  EXPECT_EQ(read(one + std::string(one.size(), '\0')), 1U) << "the mark is written last";
  EXPECT_EQ(read(""), 0U);
  EXPECT_THROW(last_state(dir.states(), 2), InputError);
}

TEST_F(LammpsStateFiles, OfOtherScenesOrProgramsAreRefused) {
  EXPECT_THROW(read(std::string(200, 'x')), InputError);
  header.elements = 3;
  EXPECT_THROW(read(bytes()), InputError);
  header.elements = 2;
  header.step = -1;
  EXPECT_THROW(read(bytes()), InputError);
  header.step = 1;
  header.work = std::nan("");
  EXPECT_THROW(read(bytes()), InputError);
  header.work = 0;
  header.of_export = 7;
  spit(dir.states(), bytes());
  EXPECT_EQ(find_states(dir.states(), 2, 7).size(), 1U);
  EXPECT_THROW(find_states(dir.states(), 2, 8), InputError) << "as many elements, and another scene";
}

// A quaternion of norm 3 placed elements where they are not.
TEST_F(LammpsStateFiles, NumbersThatLammpsDoesNotWriteAreRefused) {
  for (const Quaternion& wrong : {Quaternion(3, 0, 0, 0), Quaternion(0, 0, 0, 0), Quaternion(1.00001, 0, 0, 0)}) {
    state.orientation.set(1, wrong);
    EXPECT_THROW(read(bytes()), InputError);
  }
  state.orientation.set(1, Quaternion(1, 0, 0, 0));
  ASSERT_EQ(read(bytes()), 1U);
  for (const double wrong : {std::nan(""), HUGE_VAL, 1e300}) {
    state.velocity.set(1, {0, wrong, 0});
    EXPECT_THROW(read(bytes()), InputError);
  }
}

// A number beyond all integers was cast to one.
TEST_F(LammpsFiles, RowsThatLammpsDoesNotWriteAreRefused) {
  const std::string title =
      "step,time_ps,stretch_eV,shear_eV,bend_eV,twist_eV,vdw_eV,kinetic_eV,work_eV,dissipated_eV,heat_eV\n";
  const std::string good = "1,0,0,0,0,0,0,0,0,0,0\n";
  spit(dir.rows(), title + good + "2,0,0.5" + title + good);
  EXPECT_EQ(read_lammps_rows(dir).size(), 2U) << "a kill has cut a row off, and the run went on";
  spit(dir.rows(), "step,time_ps\n" + good);
  EXPECT_THROW(read_lammps_rows(dir), InputError) << "rows of another program";
  for (const char* row : {"1e300,0,0,0,0,0,0,0,0,0,0\n", "nan,0,0,0,0,0,0,0,0,0,0\n", "-1,0,0,0,0,0,0,0,0,0,0\n",
                          "0.5,0,0,0,0,0,0,0,0,0,0\n", "1,0,0,inf,0,0,0,0,0,0,0\n"}) {
    spit(dir.rows(), title + row);
    EXPECT_THROW(read_lammps_rows(dir), InputError) << row;
  }
  LammpsStart start;
  start.parameters = {"../other.toml"};
  spit(dir.start(), start_json(start));
  EXPECT_THROW(read_start(dir), InputError);
}

}  // namespace UNIT
}  // namespace
}  // namespace ropewalk::test
