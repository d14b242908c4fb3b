// What tethers, and other force terms whose forces follow from places alone, pull on the tubes of a scene while loads
// move the ends of these.
//
// Every tube follows its ends evenly: it is shifted, drawn out and turned as they are. The terms say their forces
// there. A tube that one end holds has the tension of all that pulls beyond; with both ends kept, the pull is shared
// so that the tube is as long as it was; with none, its inertia bears it. A tube that gives way by what it is drawn
// out relieves the term: along the line from there to the forces of the unstrained tube, the place where both agree.
// Terms on one tube count one by one, so that two of them may relieve each other more than is foreseen.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "scene/prepare.hpp"
#include "sim/dynamics/end_drives.hpp"
#include "sim/forces/force_term.hpp"

namespace ropewalk {

class TermPulls {
 public:
  // Loads of a tube of one type: least and largest tension (eV/nm), and the largest force across times its distance
  // from what holds the tube (eV).
  struct Pulls {
    double least = 0, most = 0, moment = 0;
  };

  explicit TermPulls(const Prepared& prepared);

  bool any() const { return !terms_.empty(); }
  Pulls at(double time, int type) const;

 private:
  struct OfTube {
    int tube = 0, begin = 0, length = 0;
    bool kept[2] = {false, false};  // along the tube, by end
  };
  struct Row {
    std::vector<double> tension;  // behind each element
    double moment = 0;
  };

  State moved(double time) const;
  Vec3Array forces(const ForceTerm& term, const State& state) const;
  Row row_of(const OfTube& tube, const Vec3Array& force) const;

  EndDrives drives_;
  Topology topology_;
  State start_;
  std::vector<std::unique_ptr<ForceTerm>> terms_;
  std::vector<OfTube> tubes_;
  std::vector<std::array<char, 3>> held_;  // whether each element is held, by axis
};

}  // namespace ropewalk
