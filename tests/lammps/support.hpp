// Scenes that go to LAMMPS and back: written here, run by mpirun, compared with the simulator.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "cli/support.hpp"
#include "scene/lammps_files.hpp"
#include "scene/lammps_states.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "unit/support.hpp"

namespace ropewalk::test {

// LAMMPS leaves memory to the system at its end, which is no fault of ours.
inline constexpr char leaks_allowed[] = "ASAN_OPTIONS=detect_leaks=0";

class Lammps : public Cli {
 protected:
  int threads = 1;  // of a rank

  // lmp-ropewalk in a directory of an export; one rank needs no mpirun. `program`: another one.
  Outcome lmp(int ranks, const std::string& folder, const std::string& arguments = "-in in.rope",
              const std::string& program = ROPEWALK_LMP) const {
    // Many tests at once share few cores: ranks that wait must let others work, and none is bound to a core.
    const std::string environment = "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 " +
                                    std::string(leaks_allowed) + " OMP_NUM_THREADS=" + std::to_string(threads) +
                                    " ";
    const std::string mpirun =
        "mpirun --oversubscribe --bind-to none --mca mpi_yield_when_idle 1 "
        "--mca btl_vader_single_copy_mechanism none -np " +
        std::to_string(ranks);
    const std::string command = "cd '" + (dir / folder).string() + "' && " + environment +
                                (ranks > 1 ? mpirun : "") + " '" + program + "' " + arguments +
                                " > stdout.txt 2> stderr.txt < /dev/null";
    const int status = std::system(command.c_str());
    Outcome o;
    o.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000;
    o.out = slurp(dir / folder / "stdout.txt");
    o.err = slurp(dir / folder / "stderr.txt");
    return o;
  }

  // A run that shares a start of LAMMPS with others.
  struct Part {
    std::string folder;                  // of an export, one for each part
    std::vector<std::string> variables;  // "steps 100"
  };

  // All parts one after another in one start, which costs more than they do. What a part prints is in log.lammps of
  // its folder.
  Outcome lmp_each(int ranks, const std::vector<Part>& parts) const {
    std::string script;
    for (const Part& part : parts) {
      script += "clear\nshell cd '" + (dir / part.folder).string() + "'\nlog log.lammps\n";
      for (const char* name : {"dir", "open", "from", "forces", "steps", "every"})
        script += "variable " + std::string(name) + " delete\n";
      for (const std::string& variable : part.variables) {
        const std::size_t space = variable.find(' ');
        script += "variable " + variable.substr(0, space) + " index" + variable.substr(space) + "\n";
      }
      script += "include in.rope\n";
    }
    spit(dir / "in.parts", script);
    return lmp(ranks, ".", "-in in.parts");
  }

  // Writes the scene and exports it to `folder`.
  void exported(const std::string& scene, const std::string& folder) const {
    spit(dir / "scene.toml", scene);
    const Outcome o = run("export scene.toml --force --lammps " + folder);
    ASSERT_EQ(o.code, 0) << o.err;
  }

  // Another folder of the same export, whose name is returned.
  std::string copied(const std::string& folder, const std::string& to) const {
    fs::remove_all(dir / to);
    fs::copy(dir / folder, dir / to);
    return to;
  }

  // Replaces a part of in.rope, which must be there.
  void edit(const std::string& folder, const std::string& what, const std::string& by) const {
    std::string text = slurp(dir / folder / "in.rope");
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    spit(dir / folder / "in.rope", text.replace(at, what.size(), by));
  }
};

// A tube as its centre line: points and tangents.
struct Curve {
  std::vector<Vector3> points, tangents;
};

inline Curve straight(const Vector3& middle, const Vector3& along, int elements, double length) {
  Curve c;
  for (int k = 0; k < elements; ++k) {
    c.points.push_back(middle + (k - 0.5 * (elements - 1)) * length * along.normalized());
    c.tangents.push_back(along.normalized());
  }
  return c;
}

// In the plane of `along` and `towards`, of the given radius.
inline Curve arc(const Vector3& start, const Vector3& along, const Vector3& towards, double radius, int elements,
                 double length) {
  Curve c;
  for (int k = 0; k < elements; ++k) {
    const double angle = k * length / radius;
    c.points.push_back(start + radius * (std::sin(angle) * along + (1 - std::cos(angle)) * towards));
    c.tangents.push_back(std::cos(angle) * along + std::sin(angle) * towards);
  }
  return c;
}

inline Curve helix(double radius, double rise, int elements, double length) {
  const double turn = 2 * units::pi * radius, per_turn = std::hypot(turn, rise);
  Curve c;
  for (int k = 0; k < elements; ++k) {
    const double angle = 2 * units::pi * k * length / per_turn;
    c.points.push_back({radius * std::cos(angle), radius * std::sin(angle), rise * angle / (2 * units::pi)});
    c.tangents.push_back(Vector3(-turn * std::sin(angle), turn * std::cos(angle), rise).normalized());
  }
  return c;
}

// A state file of such tubes, every element displaced and turned a little at random.
inline std::string state_text(const std::vector<Curve>& tubes, double disorder, unsigned seed) {
  Random random(seed);
  std::ostringstream text;
  text.precision(17);
  text << "tube,x_nm,y_nm,z_nm,qw,qx,qy,qz\n";
  for (std::size_t t = 0; t < tubes.size(); ++t)
    for (std::size_t k = 0; k < tubes[t].points.size(); ++k) {
      const Vector3 x = tubes[t].points[k] + disorder * random.direction();
      const Quaternion q = turn(random.direction(), disorder * random.uniform(0, 2)) *
                           Quaternion::FromTwoVectors(Vector3::UnitZ(), tubes[t].tangents[k]);
      text << t << ',' << x.x() << ',' << x.y() << ',' << x.z() << ',' << q.w() << ',' << q.x() << ',' << q.y()
           << ',' << q.z() << '\n';
    }
  return text.str();
}

// Largest difference of two arrays, over the largest value of the first.
inline double relative_difference(const Vec3Array& a, const Vec3Array& b) {
  double difference = 0, largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference = std::fmax(difference, (a[i] - b[i]).norm());
    largest = std::fmax(largest, a[i].norm());
  }
  return largest > 0 ? difference / largest : difference;
}

inline double difference_of_turns(const QuaternionArray& a, const QuaternionArray& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::fmax(largest, (a[i].coeffs() - b[i].coeffs()).norm());
  return largest;
}

// The state that LAMMPS has left at the end of its run.
struct Left {
  State state;
  Vec3Array force, torque;
};

inline Left left_by(const fs::path& folder, const Topology& topology) {
  Left out;
  LammpsStates states(LammpsDirectory{folder.string()}.states(), topology);
  EXPECT_TRUE(states.next(out.state, out.force, out.torque));
  while (states.next(out.state, out.force, out.torque)) {
  }
  return out;
}

}  // namespace ropewalk::test
