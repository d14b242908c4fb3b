#include "lammps/fix_states.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>

#include "domain.h"
#include "io/files.hpp"
#include "lammps/fix_motion.hpp"
#include "lammps/pair_mdem.hpp"
#define LAMMPS_LIB_MPI
#include "library.h"

namespace ropewalk::lammps {
namespace {

namespace fs = std::filesystem;

constexpr int numbers = std::tuple_size<StateRecord>::value;
constexpr int sent = 1 + numbers;  // the element and its record

// An open file; every failure is an InputError.
class File {
 public:
  File(std::string path, int flags)
      : path_(std::move(path)), file_(::open(path_.c_str(), flags | O_NOFOLLOW | O_CLOEXEC, 0666)) {
    if (file_ < 0) throw file_error(path_, "cannot be opened", errno);
  }
  ~File() {
    if (file_ >= 0) ::close(file_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  void read(void* to, std::size_t bytes, std::int64_t at) const {
    for (char* next = static_cast<char*>(to); bytes > 0;) {
      const ssize_t n = ::pread(file_, next, bytes, at);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) throw file_error(path_, "cannot be read", n < 0 ? errno : EIO);
      next += n, at += n, bytes -= static_cast<std::size_t>(n);
    }
  }
  void write(const void* from, std::size_t bytes, std::int64_t at) const {
    for (const char* next = static_cast<const char*>(from); bytes > 0;) {
      const ssize_t n = ::pwrite(file_, next, bytes, at);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) throw file_error(path_, "cannot be written", errno);
      next += n, at += n, bytes -= static_cast<std::size_t>(n);
    }
  }
  void cut(std::int64_t bytes) const {
    // A driver of FAT refuses to cut a file to the length that it has.
    struct stat status;
    if (::fstat(file_, &status) == 0 && status.st_size == bytes) return;
    if (::ftruncate(file_, bytes) != 0) throw file_error(path_, "cannot be written", errno);
  }
  void flush() const {
    if (!flush_to_disk(file_)) throw file_error(path_, "cannot be written", errno);
  }

 private:
  std::string path_;
  int file_;
};

// The complaint of `f`; empty: none.
template <class F>
std::string trouble_of(const F& f) {
  try {
    f();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

}  // namespace

FixStates::FixStates(LMP::LAMMPS* lmp, int count, char** words)
    : Fix(lmp, count, words),
      model_(loaded(lmp, "fix mdem/states")),
      slices_(lmp, model_->topology.elements()) {
  const bool starts = count == 7 && std::string(words[5]) == "from";
  if (igroup != 0 || (count != 5 && !starts))
    refuse(lmp, "fix mdem/states takes a number of steps, a file, and the file where the run begins",
           "write: fix states all mdem/states 1000 lammps.states from rope.state");
  const double every = LMP::utils::numeric(FLERR, words[3], false, lmp);
  if (!(every >= 1 && every <= std::numeric_limits<int>::max()) || every != static_cast<int>(every))
    refuse(lmp, std::string("fix mdem/states cannot write every ") + words[3] + " steps",
           "write a whole number from 1");
  nevery = static_cast<int>(every);
  force_reneighbor = 1;
  path_ = words[4];
  if (starts) make_elements(words[6]);
  begin_file(starts ? words[6] : path_);
}

// --- the start ----------------------------------------------------------------------------------------

void FixStates::make_elements(const std::string& path) {
  check_atoms(lmp, "fix mdem/states");
  if (!domain->box_exist || atom->natoms > 0)
    refuse(lmp, "fix mdem/states makes the elements, and needs a box without any",
           "write it behind create_box, or leave out \"from\" and what is behind it");
  if (find_fix<FixMotion>(lmp))
    refuse(lmp, "the fix that moves the elements is there before them", "write: fix states before fix motion");
  orientations(lmp);
  std::string trouble;
  if (comm->me == 0)
    trouble = trouble_of([&] { began_ = last_state(path, model_->topology.elements(), model_->start.id); });
  refuse_together(lmp, trouble);
  MPI_Bcast(&began_, sizeof began_, MPI_BYTE, 0, world);
  has_begun_ = true;
  std::vector<StateRecord> slice;
  refuse_together(lmp, trouble_of([&] { slice = read_slice(path); }));
  widen_box(slice);
  const std::vector<int> owner = owners(slice);
  std::vector<std::vector<double>> to(static_cast<std::size_t>(comm->nprocs));
  auto element = static_cast<double>(slices_.begin(comm->me));
  for (std::size_t k = 0; k < slice.size(); ++k) {
    std::vector<double>& list = to[static_cast<std::size_t>(owner[k])];
    list.push_back(element++);
    list.insert(list.end(), slice[k].begin(), slice[k].end());
  }
  create(slices_.exchange(to));
  share_memory(path, owner);
  if (update->ntimestep != began_.header.step) update->reset_timestep(LMP::bigint{began_.header.step});
}

std::vector<StateRecord> FixStates::read_slice(const std::string& path) const {
  const LMP::bigint first = slices_.begin(comm->me);
  std::vector<StateRecord> slice(static_cast<std::size_t>(slices_.begin(comm->me + 1) - first));
  const File file(path, O_RDONLY);
  file.read(slice.data(), slice.size() * sizeof(StateRecord), began_.record(first));
  for (std::size_t k = 0; k < slice.size(); ++k) {
    const std::string wrong = complaint_about(slice[k]);
    if (!wrong.empty())
      throw InputError({path, 0, ""},
                       "element " + std::to_string(first + static_cast<LMP::bigint>(k)) + ": " + wrong,
                       "was it written by the in.rope of this export?");
  }
  return slice;
}

// Records lie behind one another without an index: a rank hears from the one before it where its first one begins.
std::vector<double> FixStates::read_share_of_memory(const std::string& path) const {
  const std::int64_t all = began_.header.memory, end = all * (comm->me + 1) / comm->nprocs;
  std::int64_t first = 0;
  if (comm->me > 0) MPI_Recv(&first, 1, MPI_INT64_T, comm->me - 1, 0, world, MPI_STATUS_IGNORE);
  std::vector<double> numbers;
  std::int64_t next = std::max(first, end);
  const std::string trouble = trouble_of([&] {
    const auto fail = [&] {
      throw InputError({path, 0, ""}, "the memory of a force term is damaged",
                       "was it written by the in.rope of this export?");
    };
    const double elements = model_->topology.elements();
    // The last record of the share may go on behind it.
    for (std::int64_t until = std::min(all, end + 3); first < end;) {
      const std::size_t there = numbers.size();
      numbers.resize(static_cast<std::size_t>(until - first));
      const File file(path, O_RDONLY);
      file.read(&numbers[there], (numbers.size() - there) * sizeof(double),
                began_.record(began_.header.elements) +
                    (first + static_cast<std::int64_t>(there)) * std::int64_t{sizeof(double)});
      std::size_t at = 0;
      while (first + static_cast<std::int64_t>(at) < end) {
        if (at + 3 > numbers.size() || !(numbers[at + 1] >= an_event && numbers[at + 1] < elements) ||
            !(numbers[at + 2] >= 0 && numbers[at + 2] <= static_cast<double>(all)))
          fail();
        at += 3 + static_cast<std::size_t>(numbers[at + 2]);
      }
      next = first + static_cast<std::int64_t>(at);
      if (next > all) fail();
      if (at <= numbers.size()) {
        numbers.resize(at);
        break;
      }
      until = next;
    }
    for (const double number : numbers)
      if (!std::isfinite(number)) fail();
  });
  if (comm->me + 1 < comm->nprocs) MPI_Send(&next, 1, MPI_INT64_T, comm->me + 1, 0, world);
  refuse_together(lmp, trouble);
  return numbers;
}

// Records go to the slices of their elements, and from there to the owners. Events are in the file and stay there.
void FixStates::share_memory(const std::string& path, const std::vector<int>& owners) {
  if (began_.header.memory == 0) return;
  const std::vector<double> of_slice = slices_.bring(read_share_of_memory(path), [&](int element) {
    if (element == an_event) return -1;
    return element == the_account ? 0 : slices_.of(element);
  });
  memory_ = slices_.bring(of_slice, [&](int element) {
    return element < 0 ? 0 : owners[static_cast<std::size_t>(element - slices_.begin(comm->me))];
  });
}

// So that all elements are in it. The lower bound of its size stays, as LAMMPS would let it grow by itself.
void FixStates::widen_box(const std::vector<StateRecord>& records) {
  constexpr double margin = 1;  // nm
  std::array<double, 6> own, all;
  for (std::size_t k = 0; k < 3; ++k) own[k] = -domain->boxlo[k], own[3 + k] = domain->boxhi[k];
  for (const StateRecord& r : records)
    for (std::size_t k = 0; k < 3; ++k) {
      own[k] = std::max(own[k], margin - r[k]);
      own[3 + k] = std::max(own[3 + k], margin + r[k]);
    }
  MPI_Allreduce(own.data(), all.data(), 6, MPI_DOUBLE, MPI_MAX, world);
  for (std::size_t k = 0; k < 3; ++k) domain->boxlo[k] = -all[k], domain->boxhi[k] = all[3 + k];
  domain->set_global_box();
  domain->set_local_box();
}

// At this point LAMMPS still divides the box into a grid of bricks, one for each rank.
std::vector<int> FixStates::owners(const std::vector<StateRecord>& records) const {
  std::array<std::vector<double>, 3> low;  // lower limits of the bricks along each axis
  for (std::size_t k = 0; k < 3; ++k) {
    low[k].assign(static_cast<std::size_t>(comm->procgrid[k]), -std::numeric_limits<double>::infinity());
    low[k][static_cast<std::size_t>(comm->myloc[k])] = domain->sublo[k];
    MPI_Allreduce(MPI_IN_PLACE, low[k].data(), comm->procgrid[k], MPI_DOUBLE, MPI_MAX, world);
  }
  std::vector<int> rank;
  for (const StateRecord& r : records) {
    std::array<std::ptrdiff_t, 3> brick;
    for (std::size_t k = 0; k < 3; ++k)
      brick[k] = std::upper_bound(low[k].begin() + 1, low[k].end(), r[k]) - low[k].begin() - 1;
    rank.push_back(comm->grid2proc[brick[0]][brick[1]][brick[2]]);
  }
  return rank;
}

void FixStates::create(const std::vector<double>& records) {
  const Topology& topology = model_->topology;
  const std::size_t n = records.size() / sent;
  // Never empty: without numbers of elements LAMMPS would make some up, by a message that the other ranks do not
  // send.
  std::vector<int> tag(n + 1), type(n + 1);
  std::vector<double> x(3 * n + 1), v(3 * n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    const double* r = &records[sent * i];
    const int element = static_cast<int>(r[0]);
    tag[i] = element + 1;
    type[i] = topology.tube_type[topology.tube_of(element)] + 1;
    std::copy_n(r + 1, 3, &x[3 * i]);
    std::copy_n(r + 8, 3, &v[3 * i]);
  }
  lammps_create_atoms(lmp, static_cast<int>(n), tag.data(), type.data(), x.data(), v.data(), nullptr, 0);
  if (static_cast<std::size_t>(atom->nlocal) != n)
    refuse_one(lmp, "LAMMPS has made " + std::to_string(atom->nlocal) + " of " + std::to_string(n) + " elements",
               "take in.rope as the export has it");
  double **q = orientations(lmp), **last = carried(lmp);
  for (std::size_t i = 0; i < n; ++i) {
    const double* r = &records[sent * i];
    const auto tube = static_cast<std::size_t>(topology.tube_of(tag[i] - 1));
    const TubeType& kind = topology.types[static_cast<std::size_t>(type[i] - 1)];
    atom->molecule[i] = static_cast<int>(tube) + 1;
    atom->radius[i] = kind.radius;
    atom->rmass[i] = kind.mass;
    std::copy_n(r + 4, 4, q[i]);
    std::copy_n(r + 11, 3, atom->omega[i]);
    std::copy_n(r + 14, 6, last[i]);
    atom->num_bond[i] = tag[i] < topology.tube_begin[tube + 1] ? 1 : 0;
    if (atom->num_bond[i] == 0) continue;
    atom->bond_type[i][0] = type[i];
    atom->bond_atom[i][0] = tag[i] + 1;
  }
  atom->nbonds = topology.bonds();
}

// --- the file -----------------------------------------------------------------------------------------

// Keeps the states up to now of a file that the run continues; any other file is overwritten.
void FixStates::begin_file(const std::string& start) {
  std::string trouble;
  if (comm->me == 0)
    trouble = trouble_of([&] {
      std::error_code none;
      if (start == path_ ? fs::exists(path_) : fs::equivalent(start, path_, none))
        for (const StateInFile& s : find_states(path_, model_->topology.elements(), model_->start.id))
          if (s.header.step <= update->ntimestep) {
            place_ = {s.end(), s.header.step};
          }
      File(path_, O_RDWR | O_CREAT).cut(place_.end);
    });
  refuse_together(lmp, trouble);
  MPI_Bcast(&place_, sizeof place_, MPI_BYTE, 0, world);
}

void FixStates::go_back_to(const Place& place) {
  next_reneighbor = (update->ntimestep / nevery + 1) * nevery;
  if (place.end == place_.end) return;
  std::string trouble;
  if (comm->me == 0) trouble = trouble_of([&] { File(path_, O_RDWR).cut(place.end); });
  refuse_together(lmp, trouble);
  place_ = place;
}

void FixStates::init() { next_reneighbor = (update->ntimestep / nevery + 1) * nevery; }

void FixStates::end_of_step() {
  write();
  next_reneighbor = update->ntimestep + nevery;
}

void FixStates::post_run() {
  if (place_.written != update->ntimestep) write();
}

void FixStates::write() {
  RankEngine* engine = engine_of(lmp);
  if (engine && engine->leads()) engine->give_own();
  auto* motion = find_fix<FixMotion>(lmp);
  StateInFile state;
  state.at = place_.end;
  state.header.step = update->ntimestep;
  state.header.elements = model_->topology.elements();
  state.header.of_export = model_->start.id;
  state.header.time = model_->time_at(update->ntimestep);
  state.header.skin = engine ? engine->skin() : 0;
  if (motion) {
    const EnergySupply account = motion->account_of_all();
    state.header.work = account.work;
    state.header.dissipated = account.dissipated;
    state.header.heat = account.heat;
    state.header.set(motion->divided(), motion->control());
  }
  const auto n = static_cast<std::size_t>(atom->nlocal);
  std::vector<std::vector<double>> to(static_cast<std::size_t>(comm->nprocs));
  double** q = orientations(lmp);
  for (std::size_t i = 0; i < n; ++i) {
    const int element = element_of(*atom, static_cast<int>(i));
    std::vector<double>& list = to[static_cast<std::size_t>(slices_.of(element))];
    list.resize(list.size() + sent);
    double* r = &*list.end() - sent;
    *r = element;
    std::copy_n(atom->x[i], 3, r + 1);
    std::copy_n(q[i], 4, r + 4);
    std::copy_n(atom->v[i], 3, r + 8);
    std::copy_n(atom->omega[i], 3, r + 11);
    std::copy_n(atom->f[i], 3, r + 14);
    std::copy_n(atom->torque[i], 3, r + 17);
  }
  std::vector<double> memory = engine ? engine->memory() : std::vector<double>();
  if (motion) {
    const std::vector<double> events = motion->take_events();
    memory.insert(memory.end(), events.begin(), events.end());
  }
  const auto numbers_here = static_cast<std::int64_t>(memory.size());
  std::int64_t up_to_here = 0;
  MPI_Scan(&numbers_here, &up_to_here, 1, MPI_INT64_T, MPI_SUM, world);
  MPI_Allreduce(&numbers_here, &state.header.memory, 1, MPI_INT64_T, MPI_SUM, world);
  const std::vector<double> mine = slices_.exchange(to);
  refuse_together(lmp, trouble_of([&] { write_slice(state, mine, memory, up_to_here - numbers_here); }));
  // The header says that the rest is there.
  std::string trouble;
  if (comm->me == 0)
    trouble = trouble_of([&] { File(path_, O_RDWR).write(&state.header, sizeof state.header, state.at); });
  refuse_together(lmp, trouble);
  place_ = {state.end(), update->ntimestep};
}

void FixStates::write_slice(const StateInFile& state, const std::vector<double>& records,
                            const std::vector<double>& memory, std::int64_t memory_before) const {
  const LMP::bigint first = slices_.begin(comm->me);
  std::vector<StateRecord> slice(static_cast<std::size_t>(slices_.begin(comm->me + 1) - first));
  for (std::size_t k = 0; k < records.size(); k += sent)
    std::copy_n(&records[k + 1], numbers,
                slice[static_cast<std::size_t>(records[k]) - static_cast<std::size_t>(first)].data());
  if (slice.empty() && memory.empty()) return;
  const File file(path_, O_RDWR);
  file.write(slice.data(), slice.size() * sizeof(StateRecord), state.record(first));
  file.write(memory.data(), memory.size() * sizeof(double),
             state.record(state.header.elements) + memory_before * std::int64_t{sizeof(double)});
  file.flush();
}

}  // namespace ropewalk::lammps
