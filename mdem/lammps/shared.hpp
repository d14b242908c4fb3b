// What the styles of one LAMMPS instance know of one another, and what they need of LAMMPS in one place.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "atom.h"
#include "comm.h"
#include "error.h"
#include "fix.h"
#include "force.h"
#include "lammps.h"
#include "lammps/model.hpp"
#include "modify.h"
#include "update.h"

namespace ropewalk::lammps {

namespace LMP = LAMMPS_NS;

class FixGrip;
class FixDamp;
class FixMotion;

// The model that a pair or bond style has loaded; it lives as long as one of them.
std::shared_ptr<const LammpsModel> load(LMP::LAMMPS* lmp, const std::string& directory);
std::shared_ptr<const LammpsModel> loaded(LMP::LAMMPS* lmp, const char* who);

// Stops all ranks with one line, where all of them come here.
[[noreturn]] void refuse(LMP::LAMMPS* lmp, const std::string& what, const std::string& remedy);
// Stops all ranks from one.
[[noreturn]] void refuse_one(LMP::LAMMPS* lmp, const std::string& what, const std::string& remedy);

// Atom style, units, box and Newton's third law as the styles need them.
void check_atoms(LMP::LAMMPS* lmp, const char* who);
// That all fixes and styles of the model are there, once.
void check_styles(LMP::LAMMPS* lmp, const LammpsModel& model);

template <class F>
F* find_fix(LMP::LAMMPS* lmp) {
  for (int k = 0; k < lmp->modify->nfix; ++k)
    if (auto* fix = dynamic_cast<F*>(lmp->modify->fix[k])) return fix;
  return nullptr;
}

// The orientations w, x, y, z of own and ghost elements. LAMMPS moves the array about: ask again in every call.
double** orientations(LMP::LAMMPS* lmp);
// Of own elements: total force and torque at the end of the last step.
double** carried(LMP::LAMMPS* lmp);

inline Vector3 vector(const double* v) { return {v[0], v[1], v[2]}; }
inline Quaternion quaternion(const double* q) { return {q[0], q[1], q[2], q[3]}; }
inline void add(double* to, const Vector3& v) {
  to[0] += v.x();
  to[1] += v.y();
  to[2] += v.z();
}
inline void store(double* to, const Vector3& v) {
  to[0] = v.x();
  to[1] = v.y();
  to[2] = v.z();
}

// Element of the scene, from 0, of a local or ghost atom.
inline int element_of(const LMP::Atom& atom, int i) { return static_cast<int>(atom.tag[i]) - 1; }
inline const TubeType& type_of(const LammpsModel& model, const LMP::Atom& atom, int i) {
  return model.topology.types[static_cast<std::size_t>(atom.type[i] - 1)];
}

double sum_over_ranks(LMP::LAMMPS* lmp, double value);

}  // namespace ropewalk::lammps
