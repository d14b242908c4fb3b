// The files of an export, where no LAMMPS is needed.
#include "scene/lammps_files.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "model/error.hpp"
#include "unit/support.hpp"

namespace ropewalk::test {
namespace {

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
  spit(dir.start(), "{\"format\": \"ropewalk-lammps-1\"}");
  EXPECT_THROW(read_start(dir), InputError);
}

// LAMMPS cuts lines of a data file after 255 characters.
TEST_F(LammpsFiles, LongestLinesFit) {
  Topology t = published_topology();
  t.add_tube(1);
  State s(1);
  const double long_one = -1.2345678901234567e-11, longest = -1.2345678901234567e-98;
  s.position.set(0, Vector3::Constant(long_one));
  s.velocity.set(0, Vector3::Constant(longest));
  s.angular_velocity.set(0, Vector3::Constant(longest));
  s.orientation.set(0, Quaternion(-0.12345678901234567, long_one, long_one, long_one));
  Vec3Array force(1), torque(1);
  force.set(0, Vector3::Constant(longest));
  torque.set(0, Vector3(-1.2345678901234567e-200, longest, longest));
  std::istringstream text(lammps_data("long", t, s, force, torque));
  std::size_t most = 0;
  for (std::string line; std::getline(text, line);) most = std::max(most, line.size());
  EXPECT_LE(most, 245U);  // and ten digits of an element's number, of which one is there
  EXPECT_GT(most, 200U);
}

TEST_F(LammpsFiles, DumpsWithOtherColumnsAreRefused) {
  Topology t = published_topology();
  t.add_tube(1);
  const std::string head =
      "ITEM: TIMESTEP\n5\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS mm mm mm\n0 1\n0 1\n0 1\n";
  const std::string columns =
      "ITEM: ATOMS tqx id x y z d2_quat[1] d2_quat[2] d2_quat[3] d2_quat[4] vx vy vz omegax omegay omegaz fx fy fz "
      "tqy tqz\n";
  const std::string numbers = "18 1 0.1 0.2 0.3 1 0 0 0 9 10 11 12 13 14 15 16 17 19 20\n";
  const auto read = [&](const std::string& text, State& s) {
    spit(dir.states(), text);
    LammpsStates states(dir.states());
    Vec3Array force, torque;
    const bool found = states.next(t, s, force, torque);
    if (found) {
      EXPECT_EQ(torque[0], Vector3(18, 19, 20));
    }
    return found;
  };
  State s;
  ASSERT_TRUE(read(head + columns + numbers, s));
  EXPECT_EQ(s.step, 5);
  EXPECT_EQ(s.position[0], Vector3(0.1, 0.2, 0.3));
  EXPECT_EQ(s.angular_velocity[0], Vector3(12, 13, 14));
  EXPECT_FALSE(read(head + columns + "18 1 0.1 0.2", s));  // cut off
  EXPECT_THROW(read(head + "ITEM: ATOMS id x y z\n1 0 0 0\n", s), InputError);
  EXPECT_THROW(read(head + columns + "18 2 0.1 0.2 0.3 1 0 0 0 9 10 11 12 13 14 15 16 17 19 20\n", s), InputError);
  EXPECT_THROW(read(head + columns + "18 1 0.1\n", s), InputError);
}

// A quaternion of norm 3 placed elements where they are not; a number beyond all integers was cast to one.
TEST_F(LammpsFiles, NumbersThatLammpsDoesNotWriteAreRefused) {
  Topology t = published_topology();
  t.add_tube(1);
  const std::string head =
      "ITEM: TIMESTEP\n5\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS mm mm mm\n0 1\n0 1\n0 1\nITEM: ATOMS id x y z "
      "d2_quat[1] d2_quat[2] d2_quat[3] d2_quat[4] vx vy vz omegax omegay omegaz fx fy fz tqx tqy tqz\n";
  const auto read = [&](const std::string& numbers) {
    spit(dir.states(), head + numbers + " 1 2 3 4 5 6 7 8 9 10 11 12\n");
    LammpsStates states(dir.states());
    State s;
    Vec3Array force, torque;
    return states.next(t, s, force, torque);
  };
  EXPECT_TRUE(read("1 0 0 0 1 0 0 0"));
  for (const char* wrong :
       {"1 0 0 0 3 0 0 0", "1 0 0 0 0 0 0 0", "1 nan 0 0 1 0 0 0", "1 0 inf 0 1 0 0 0", "1 0 0 1e300 1 0 0 0",
        "1e300 0 0 0 1 0 0 0", "nan 0 0 0 1 0 0 0", "1.5 0 0 0 1 0 0 0", "1 0 0 0 1.00001 0 0 0"})
    EXPECT_THROW(read(wrong), InputError) << wrong;
  const std::string title = "step,time_ps,stretch_eV\n";
  for (const char* row : {"1e300,0,0,0,0,0,0,0,0,0\n", "nan,0,0,0,0,0,0,0,0,0\n", "-1,0,0,0,0,0,0,0,0,0\n",
                          "0.5,0,0,0,0,0,0,0,0,0\n", "1,0,0,inf,0,0,0,0,0,0\n"}) {
    spit(dir.rows(), title + row);
    EXPECT_THROW(read_lammps_rows(dir), InputError) << row;
  }
  spit(dir.start(),
       "{\"format\": \"ropewalk-lammps-1\", \"step\": 1, \"time_ps\": 0, \"time_step_ps\": 1, \"work_eV\": 0, "
       "\"dissipated_eV\": 0, \"viscosity_inner_nm\": 0, \"viscosity_outer_nm\": 0, \"parameters\": "
       "[\"../other.toml\"]}");
  EXPECT_THROW(read_start(dir), InputError);
}

}  // namespace
}  // namespace ropewalk::test
