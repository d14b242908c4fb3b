// fix ID all mdem/states EVERY FILE [from START]: makes the elements of the last state in START, and adds their
// states to FILE every EVERY steps and at the end of a run. The files are those of scene/lammps_states.hpp. Each
// rank reads and writes a slice of them, of elements with consecutive numbers; messages bring elements from and to
// their owners.
//
// LAMMPS goes on from any state to the same bits, on as many ranks: at every state elements are exchanged.
#pragma once

#include "lammps/slices.hpp"
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

  // The end of the file, and back to it: the states behind it are written again. All ranks.
  struct Place {
    std::int64_t end = 0;        // bytes
    LMP::bigint written = -1;  // step of the last state
  };
  Place place() const { return place_; }
  void go_back_to(const Place& place);

 private:
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
  Slices slices_;
  std::string path_;
  StateInFile began_;
  bool has_begun_ = false;
  std::vector<double> memory_;
  Place place_;
};

}  // namespace ropewalk::lammps
