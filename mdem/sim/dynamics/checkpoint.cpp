// Everything that the future of a simulation depends on, as bytes. Layout: `CheckpointHead`, then the values in the
// order of visit_checkpoint, which serves both ways. Numbers are as this machine holds them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "sim/dynamics/simulation.hpp"
#include "sim/state/byte_archive.hpp"

namespace ropewalk {
namespace {

constexpr char magic[8] = "MDEM17";

struct CheckpointHead {
  char format[sizeof magic];
  std::int64_t elements = 0, tubes = 0;
};

// The state that the neighbour list and the memories of terms are rebuilt from, and that the next list depends on.
struct ListAndMemories {
  std::vector<double> memory;
  double skin = 0;
  std::array<double, 2> twist{};
  Vec3Array position, axis;
};

struct Writer : ByteWriter {
  using ByteWriter::operator();
  void operator()(const Column& v) {
    bytes.append(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(double));
  }
  void operator()(const std::vector<double>& numbers) {
    (*this)(static_cast<std::int64_t>(numbers.size()));
    bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(double));
  }
  void operator()(const std::vector<PointLoad>& loads) {
    (*this)(static_cast<std::int64_t>(loads.size()));
    for (const PointLoad& load : loads) {
      (*this)(load.element);
      for (const Vector3* v : {&load.force, &load.torque})
        for (int k = 0; k < 3; ++k) (*this)((*v)[k]);
    }
  }
};

// Arrays must have their size.
struct Reader : ByteReader {
  using ByteReader::operator();
  void operator()(Column& v) {
    const std::size_t size = v.size() * sizeof(double);
    if (size > 0) std::memcpy(v.data(), take(size).data(), size);
  }
  void operator()(std::vector<double>& numbers) {
    std::int64_t count = 0;
    (*this)(count);
    if (count < 0 || static_cast<std::uint64_t>(count) > bytes.size() / sizeof(double))
      throw std::runtime_error("the checkpoint ends too early");
    numbers.resize(static_cast<std::size_t>(count));
    const std::size_t size = numbers.size() * sizeof(double);
    if (size > 0) std::memcpy(numbers.data(), take(size).data(), size);
  }
  void operator()(std::vector<PointLoad>& loads) {
    std::int64_t count = 0;
    (*this)(count);
    loads.clear();
    for (; count > 0; --count) {
      PointLoad load;
      (*this)(load.element);
      for (Vector3* v : {&load.force, &load.torque})
        for (int k = 0; k < 3; ++k) (*this)((*v)[k]);
      loads.push_back(load);
    }
  }
};

// V: a Vec3Array or a QuaternionArray, const or not.
template <class Archive, class V>
void visit_xyz(Archive& archive, V& v) {
  archive(v.x);
  archive(v.y);
  archive(v.z);
}

template <class Archive, class F>
void visit_forces(Archive& archive, F& f) {
  visit_xyz(archive, f.force);
  visit_xyz(archive, f.torque);
}

}  // namespace

template <class Archive, class R>
void visit_relaxation(Archive& archive, R& r) {
  archive(r.began);
  archive(r.part_began);
  archive(r.disturbances);
  for (auto* x : {&r.goal.force, &r.goal.energy, &r.first_energy, &r.force, &r.constant, &r.longest_bond,
                  &r.last_step, &r.disturbed_from, &r.fire.dt_max, &r.fire.dt_min, &r.fire.dt, &r.fire.mix})
    archive(*x);
  archive(r.fire.downhill);
  archive(r.newton.newton);
  archive(r.newton.saddles);
  for (auto* x : {&r.newton.rate, &r.newton.falling, &r.newton.saddle_energy}) archive(*x);
}

template <class Archive, class Self, class List>
void Simulation::visit_checkpoint(Archive& archive, Self& self, List& list) {
  auto& s = self.state_;
  archive(self.time_step_);
  archive(self.divided_);
  archive(s.time);
  archive(s.step);
  archive(self.account_);
  archive(self.gauges_.sums);
  archive(self.thermostat_variables_);
  archive(self.list_age_);
  archive(list.memory);
  archive(list.skin);
  archive(list.twist);
  visit_xyz(archive, list.position);
  visit_xyz(archive, list.axis);
  visit_xyz(archive, s.position);
  archive(s.orientation.w);
  visit_xyz(archive, s.orientation);
  visit_xyz(archive, s.velocity);
  visit_xyz(archive, s.angular_velocity);
  visit_forces(archive, self.forces_);
  archive(self.forces_.energy);
  archive(self.forces_.term_energy);
  archive(self.forces_.damping_power);
  archive(self.point_loads_);
  visit_relaxation(archive, self.relaxation_);
  archive(self.rest_.step);
  archive(self.rest_.saddles);
  archive(self.rest_.falls);
}

namespace {

// In nm, ps and eV, and in units of these; beyond it a state is no longer one.
constexpr double largest_number = 1e9;

template <class Numbers>
bool all_within(const Numbers& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return std::fabs(x) < largest_number; });
}

template <class V>
bool all_xyz_within(const V& v) {
  return all_within(v.x) && all_within(v.y) && all_within(v.z);
}

bool are_unit_vectors(const Vec3Array& v) {
  for (std::size_t i = 0; i < v.size(); ++i)
    if (!(std::fabs(v[i].norm() - 1) < 1e-3)) return false;
  return true;
}

bool could_be(const ListAndMemories& list) {
  return all_within(list.memory) && list.skin > 0 && list.skin < largest_number && all_within(list.twist) &&
         all_xyz_within(list.position) && are_unit_vectors(list.axis);
}

bool could_be(const Relaxation& r, std::int64_t step, double longest_step) {
  if (!r.underway()) return true;
  const Fire& f = r.fire;
  const bool fire_goes_on = r.part_began >= 0;
  return r.began <= step && r.part_began <= step && (r.part_began < 0 || r.part_began >= r.began) &&
         all_within(std::array{r.goal.force, r.goal.energy, r.first_energy, r.force, r.constant, r.longest_bond,
                               r.disturbed_from}) &&
         r.disturbances >= 0 && r.disturbances <= step && std::fabs(r.last_step) < longest_step &&
         (!fire_goes_on ||
          (f.dt_max > 0 && f.dt_max < longest_step && f.dt_min >= 0 && f.dt_min <= f.dt && f.dt <= f.dt_max &&
           f.mix >= 0 && f.mix <= 1 && f.downhill >= 0 && f.downhill <= step)) &&
         all_within(std::array{r.newton.rate, r.newton.falling, r.newton.saddle_energy}) && r.newton.rate >= 0 &&
         r.newton.falling >= 0 && r.newton.saddles >= 0 && r.newton.saddles <= step;
}

}  // namespace

// Whether a simulation could go on from here, which a sum over the bytes does not tell.
bool Simulation::could_go_on(double step_of_scene) const {
  const State& s = state_;
  constexpr std::int64_t most_steps = 1000000000000000;
  bool fine = time_step_ > 0 && time_step_ < 1e3 * step_of_scene && divided_ >= 1 && divided_ <= 1024 &&
              s.step >= 0 && s.step < most_steps && list_age_ >= 0 && list_age_ < most_steps &&
              could_be(relaxation_, s.step, 1e3 * step_of_scene) && rest_.step <= s.step && rest_.saddles >= 0 &&
              rest_.falls >= 0 &&
              all_within(std::array{s.time, account_.work, account_.dissipated, account_.heat, gauges_.sums.since});
  fine = fine && all_within(thermostat_variables_);
  for (const Vec3Array* v : {&s.position, &s.velocity, &s.angular_velocity, &forces_.force, &forces_.torque})
    fine = fine && all_xyz_within(*v);
  for (std::size_t i = 0; fine && i < s.size(); ++i) fine = std::fabs(s.orientation[i].norm() - 1) < 1e-3;
  fine = fine && forces_.term_energy.size() == interaction_.terms.size();
  for (const PointLoad& load : point_loads_)
    fine = fine && load.element >= 0 && load.element < topology_.elements() && load.force.allFinite() &&
           load.torque.allFinite();
  return fine;
}

std::string Simulation::serialise() const {
  download();
  Writer write;
  // The numbers of one element: 13 of its state, 6 of its place and axis in the neighbour list, 6 of its force and
  // torque. Room is reserved, since a growing string takes up to twice its size.
  constexpr std::size_t bytes_of_element = (13 + 6 + 6) * sizeof(double);
  write.bytes.reserve(bytes_of_element * state_.size() + (1 << 16));
  CheckpointHead head{{}, topology_.elements(), topology_.tubes()};
  std::memcpy(head.format, magic, sizeof magic);
  write(head);
  const ListAndMemories list{memory(), list_.skin, list_.twist(), list_.reference(), list_.reference_axis()};
  visit_checkpoint(write, *this, list);
  write.bytes.shrink_to_fit();
  return std::move(write.bytes);
}

void Simulation::restore(const std::string& bytes) {
  sync_to_host();
  Reader read{{bytes}};
  CheckpointHead head;
  read(head);
  if (std::memcmp(head.format, magic, sizeof magic) != 0)
    throw std::runtime_error("not a checkpoint of this version");
  if (head.elements != topology_.elements() || head.tubes != topology_.tubes())
    throw std::runtime_error("the checkpoint holds " + std::to_string(head.tubes) + " tubes of " +
                             std::to_string(head.elements) + " elements, the scene " +
                             std::to_string(topology_.tubes()) + " of " + std::to_string(topology_.elements()));
  ListAndMemories list;
  list.position.resize(state_.size());
  list.axis.resize(state_.size());
  const double step_of_scene = time_step_;
  const std::size_t variables = thermostat_variables_.size();
  visit_checkpoint(read, *this, list);
  if (thermostat_variables_.size() != variables)
    throw std::runtime_error("the checkpoint holds " + std::to_string(thermostat_variables_.size()) +
                             " internal variables of a thermostat, that of the scene has " +
                             std::to_string(variables));
  if (!read.bytes.empty()) throw std::runtime_error("the checkpoint is longer than the state of this scene");
  if (!could_go_on(step_of_scene) || !could_be(list))
    throw std::runtime_error(
        "the checkpoint holds a state that no run can have: a number is not finite or out of range");
  state_.part = 0;
  list_.skin = list.skin;
  list_.build(topology_, std::move(list.position), std::move(list.axis));
  list_.set_twist(list.twist);
  engine_.set_memory(interaction_, list.memory, topology_.elements());
  engine_.prepare_again(topology_, list_, state_);
  // The line law's list, which the skin of the next one follows from.
  Forces made(state_.size());
  if (tunes_skin_ && engine_.contact())
    engine_.compute(topology_, interaction_, list_, state_, made, {Parts::contact, false});
}

}  // namespace ropewalk
