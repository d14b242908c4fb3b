// Functions that the styles share: access to one another within a LAMMPS instance, and all checks of LAMMPS's
// settings.
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
#include "sim/state/processes.hpp"
#include "update.h"

namespace ropewalk::lammps {

namespace LMP = LAMMPS_NS;

class FixGrip;
class FixDamp;
class FixMotion;

// The model that a pair or bond style has loaded. It exists as long as one of them.
std::shared_ptr<const LammpsModel> load(LMP::LAMMPS* lmp, const std::string& directory);
std::shared_ptr<const LammpsModel> loaded(LMP::LAMMPS* lmp, const char* who);

// Stops all ranks with one line. All ranks must call it.
[[noreturn]] void refuse(LMP::LAMMPS* lmp, const std::string& what, const std::string& remedy);
// Stops all ranks. A single rank may call it.
[[noreturn]] void refuse_one(LMP::LAMMPS* lmp, const std::string& what, const std::string& remedy);

// Stops all ranks with one line if any rank has trouble, such as a missing file. All ranks must call it.
void refuse_together(LMP::LAMMPS* lmp, std::string trouble);

// Checks atom style, units, box and the `newton` setting.
void check_atoms(LMP::LAMMPS* lmp, const char* who);
// Checks that every fix and style of the model is present once.
void check_styles(LMP::LAMMPS* lmp, const LammpsModel& model);

template <class F>
F* find_fix(LMP::LAMMPS* lmp) {
  for (int k = 0; k < lmp->modify->nfix; ++k)
    if (auto* fix = dynamic_cast<F*>(lmp->modify->fix[k])) return fix;
  return nullptr;
}

// The orientations w, x, y, z of own and ghost elements. LAMMPS may move the array: call it again every time.
double** orientations(LMP::LAMMPS* lmp);
// Total force and torque on own elements at the end of the last step.
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

// The element of the scene, counted from 0, that a local or ghost atom stands for.
inline int element_of(const LMP::Atom& atom, int i) { return static_cast<int>(atom.tag[i]) - 1; }
inline const TubeType& type_of(const LammpsModel& model, const LMP::Atom& atom, int i) {
  return model.topology.types[static_cast<std::size_t>(atom.type[i] - 1)];
}

double sum_over_ranks(LMP::LAMMPS* lmp, double value);
// The lists of all ranks behind one another, on the first rank; none on the others. All ranks.
std::vector<double> on_first_rank(LMP::LAMMPS* lmp, const std::vector<double>& own);

// The messages of the ranks that loads and force terms need.
class RankMessages : public Processes {
 public:
  explicit RankMessages(MPI_Comm world) : world_(world) {}
  void sum(double* values, std::size_t count) const override;
  std::vector<int> join(const std::vector<int>& own) const override;

 private:
  MPI_Comm world_;
};

}  // namespace ropewalk::lammps
