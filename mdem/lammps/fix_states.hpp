// fix ID all mdem/states EVERY FILE [from START]: makes the elements of the last state in START, and adds their
// states to FILE every EVERY steps and at the end of a run. The files are those of scene/lammps_states.hpp. Each
// rank reads and writes a slice of them, of elements with consecutive numbers; messages bring elements from and to
// their owners.
//
// LAMMPS goes on from any state to the same bits, on as many ranks: at every state elements are exchanged.
#pragma once

#include "lammps/shared.hpp"
#include "scene/lammps_states.hpp"

namespace ropewalk::lammps {

class FixStates : public LMP::Fix {
 public:
  FixStates(LMP::LAMMPS* lmp, int count, char** words);
  int setmask() override { return LMP::FixConst::END_OF_STEP; }
  void init() override;
  void end_of_step() override;
  void post_run() override;

  // The header of the state that the run began with; null if this fix has not made the elements.
  const StateHeader* began() const { return has_begun_ ? &began_.header : nullptr; }
  // The memories of force terms there: those of the elements that this rank has made, on the first rank the accounts
  // too.
  const std::vector<double>& memory() const { return memory_; }

 private:
  LMP::bigint slice_begin(int rank) const;
  int slice_of(LMP::bigint element) const;
  std::vector<double> exchange(const std::vector<std::vector<double>>& to) const;
  void make_elements(const std::string& path);
  std::vector<StateRecord> read_slice(const std::string& path) const;
  std::vector<double> read_share_of_memory(const std::string& path) const;
  void share_memory(const std::string& path, const std::vector<int>& owners);
  void widen_box(const std::vector<StateRecord>& records);
  std::vector<int> owners(const std::vector<StateRecord>& records) const;
  void create(const std::vector<double>& records);
  void begin_file(const std::string& start);
  void write();
  void write_slice(const StateInFile& state, const std::vector<double>& records, const std::vector<double>& memory,
                   std::int64_t memory_before) const;

  std::shared_ptr<const LammpsModel> model_;
  std::string path_;
  StateInFile began_;
  bool has_begun_ = false;
  std::vector<double> memory_;
  std::int64_t end_ = 0;  // end of the last state in the file, bytes
  LMP::bigint written_ = -1;
};

}  // namespace ropewalk::lammps
