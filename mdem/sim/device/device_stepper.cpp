#include "sim/device/device_stepper.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "model/contract.hpp"
#include "sim/contact/line/list.hpp"
#include "sim/contact/line/radial_table.hpp"
#include "sim/neighbours/excluded.hpp"

namespace ropewalk {
#include "sim/device/types.h"
namespace {

const LineLaw* law_of(const Interaction& in) { return dynamic_cast<const LineLaw*>(in.law.get()); }

int nodes_of(const LineLaw& law) {
  int most = 1;
  for (const LineContact& pair : law.pairs) most = std::max(most, pair.nodes_i);
  return most;
}

LineTables line_tables(const LineLaw& law, int types, double unit) {
  LineTables out{};
  out.unit = unit;
  for (int i = 0; i < types; ++i)
    for (int j = 0; j < types; ++j) {
      const LineContact& pair = law.of({i, j});
      const RadialTable<float, SEGMENTS, TERMS> table(pair.density, unit);
      PairTable& to = out.pair[i * types + j];
      for (int m = 0; m < TERMS; ++m) std::copy(table.d[m], table.d[m] + SEGMENTS, to.d + m * SEGMENTS);
      to.scale = table.scale, to.shift = table.shift, to.core2 = table.core2, to.cutoff2 = table.cutoff2;
      to.unit = table.unit, to.rest = table.contact + table.core, to.v1 = table.v1, to.v2 = table.v2;
      to.weight = static_cast<float>(static_cast<double>(table.force) * pair.length_i / pair.nodes_i *
                                     pair.length_j / pair.nodes_j);
      out.cutoff[i * types + j] = pair.density.cutoff();
      NodeRow& row = out.row[i];
      row.count = pair.nodes_i;
      for (int k = 0; k < pair.nodes_i; ++k)
        row.s[k] = static_cast<float>(line_node(k, pair.nodes_i, pair.length_i) / unit);
      row.rim = row.s[pair.nodes_i - 1];
    }
  return out;
}

// The columns of `motion` and of `force` in kernels.h, in their order.
template <class S>
auto columns_of(S& s) {
  return std::array{&s.position.x,        &s.position.y,    &s.position.z,         &s.orientation.w,
                    &s.orientation.x,     &s.orientation.y, &s.orientation.z,      &s.velocity.x,
                    &s.velocity.y,        &s.velocity.z,    &s.angular_velocity.x, &s.angular_velocity.y,
                    &s.angular_velocity.z};
}
template <class F>
auto force_columns_of(F& f) {
  return std::array{&f.force.x, &f.force.y, &f.force.z, &f.torque.x, &f.torque.y, &f.torque.z};
}

// 0, and the sums of the first, of the first two, and so on.
std::vector<int> sums_of(const std::vector<int>& counts) {
  std::vector<int> sums(counts.size() + 1, 0);
  std::partial_sum(counts.begin(), counts.end(), sums.begin() + 1);
  return sums;
}

}  // namespace

std::string not_for_a_device(const Topology& topology, const Interaction& in) {
  if (in.law && !law_of(in))
    return "devices have the contact law \"line\" alone, and this scene has \"" + in.law->name() + "\"";
  if (!in.terms.empty()) return "devices have no \"" + in.terms.front()->name() + "\"";
  if (in.damping.local > 0) return "devices have no damping.pfc_local";
  if (in.law && in.precision == Interaction::Precision::full)
    return "devices compute the contact in single precision, and this scene has precision = \"double\"";
  if (topology.part) return "devices share no scene with other processes";
  if (topology.types.size() > MAX_TYPES)
    return "devices have up to " + std::to_string(MAX_TYPES) + " kinds of tubes, and this scene has " +
           std::to_string(topology.types.size());
  if (in.law && nodes_of(*law_of(in)) > MAX_NODES)
    return "devices have up to " + std::to_string(MAX_NODES) + " nodes on an element, and this scene has " +
           std::to_string(nodes_of(*law_of(in)));
  return "";
}

DeviceStepper::DeviceStepper(const Topology& topology, const Interaction& interaction, const std::string& device)
    : topology_(topology), interaction_(interaction) {
  const std::string why = not_for_a_device(topology, interaction);
  if (!why.empty()) throw std::invalid_argument("a device cannot run this scene: " + why);
  const LineLaw* const law = law_of(interaction);
  device_ = open_device(device, {law ? nodes_of(*law) : 1, static_cast<int>(topology.types.size())});
  name_ = device_->name();
  elements_ = topology.elements();
  stride_ = (elements_ + 31) / 32 * 32;
  groups_ = (elements_ + GROUP - 1) / GROUP;
  const auto n = static_cast<std::size_t>(stride_), quad = 16 * n, column = sizeof(double) * n;
  motion_ = allocate(13 * column), force_ = allocate(6 * column), bond_ = allocate(10 * column);
  reference_ = allocate(6 * column), told_ = allocate(TOLD * column);
  for (Device::Memory* of_four : {&centre_, &axis_, &velocity_, &spin_, &contact_force_, &contact_torque_})
    *of_four = allocate(quad);
  const std::vector<float> nothing(4 * n, 0.0F);  // where there is no contact
  device_->write(contact_force_, nothing.data(), quad);
  device_->write(contact_torque_, nothing.data(), quad);
  std::vector<ElementType> types;
  for (const TubeType& t : topology.types)
    types.push_back({t.mass, t.inertia, t.element_length, shear_share(t.bond, t.element_length), t.bond,
                     bond_shape(t.bond, t.element_length)});
  types_ = send(types);
  for (buckets_ = 64; buckets_ < elements_ / 2; buckets_ *= 2) {
  }
  const auto buckets = static_cast<std::size_t>(buckets_);
  last_ = send(last_excluded(topology, interaction.excluded_arc()));
  cell_ = allocate(quad), member_ = allocate(n * sizeof(int)), counts_ = allocate(n * sizeof(int)),
  begin_ = allocate((n + 1) * sizeof(int));
  first_ = allocate((buckets + 1) * sizeof(int)), next_ = allocate(buckets * sizeof(int));
}

Device::Memory DeviceStepper::allocate(std::size_t bytes) {
  bytes_ += bytes;
  return device_->allocate(bytes);
}

template <class T>
Device::Memory DeviceStepper::send(const std::vector<T>& numbers) {
  const std::size_t bytes = numbers.size() * sizeof(T);
  Device::Memory memory = device_->allocate(bytes);
  device_->write(memory, numbers.data(), bytes);
  return memory;
}

template <class Columns>
void DeviceStepper::send_columns(const Columns& columns, const Device::Memory& to) {
  const auto n = static_cast<std::size_t>(stride_);
  std::vector<double> numbers(columns.size() * n);
  for (std::size_t c = 0; c < columns.size(); ++c)
    std::copy(columns[c]->begin(), columns[c]->end(), numbers.begin() + static_cast<std::ptrdiff_t>(c * n));
  device_->write(to, numbers.data(), numbers.size() * sizeof(double));
}

void DeviceStepper::take(const State& state, const Forces& forces, std::vector<int> hosted,
                         const NeighbourList& list) {
  ROPEWALK_EXPECTS(static_cast<int>(state.size()) == elements_ && std::is_sorted(hosted.begin(), hosted.end()));
  hosted_ = std::move(hosted);
  rows_.resize(13 * std::max<std::size_t>(hosted_.size(), 1));
  std::vector<int> kind(static_cast<std::size_t>(elements_), 0);
  for (int t = 0; t < topology_.tubes(); ++t)
    for (int i = topology_.tube_begin[t]; i < topology_.tube_begin[t + 1]; ++i)
      kind[static_cast<std::size_t>(i)] = topology_.tube_type[static_cast<std::size_t>(t)] +
                                          (i + 1 < topology_.tube_begin[t + 1] ? KIND_BONDED : 0);
  for (const int i : hosted_) kind[static_cast<std::size_t>(i)] |= KIND_HOSTED;
  kind_ = send(kind);
  which_ = send(hosted_);
  hosted_motion_ = send(rows_);
  sums_.resize(static_cast<std::size_t>(SUMMARY * groups_) + 6 * hosted_.size());
  summary_ = send(sums_);
  send_columns(columns_of(state), motion_);
  send_columns(force_columns_of(forces), force_);
  use_list(list);
}

void DeviceStepper::use_list(const NeighbourList& list) {
  const LineLaw* const law = law_of(interaction_);
  unit_ = list.coordinate_unit();
  if (law && !tables_)
    tables_ = send(std::vector<LineTables>{line_tables(*law, static_cast<int>(topology_.types.size()), unit_)});
  const Vec3Array &x = list.reference(), &n = list.reference_axis();
  send_columns(std::array{&x.x, &x.y, &x.z, &n.x, &n.y, &n.z}, reference_);
  if (law) find_neighbours(list);
}

// Sums of counts are made here: the counts are few against the state.
void DeviceStepper::find_neighbours(const NeighbourList& list) {
  const auto n = static_cast<std::size_t>(elements_), buckets = static_cast<std::size_t>(buckets_);
  const double viscosity = interaction_.damped_contact() ? interaction_.damping.contact.outer + list.skin : 0;
  const ListReach reach{list.cutoff + list.skin, viscosity, list.skin};
  std::vector<int> count(buckets, 0);
  device_->write(next_, count.data(), buckets * sizeof(int));
  device_->run("count_cells", groups_, reference_, reach, elements_, stride_, buckets_, cell_, next_);
  device_->read(next_, count.data(), buckets * sizeof(int));
  std::vector<int> sum = sums_of(count);
  device_->write(first_, sum.data(), sum.size() * sizeof(int));
  device_->write(next_, sum.data(), buckets * sizeof(int));
  device_->run("fill_cells", groups_, cell_, elements_, next_, member_);
  const auto find = [&](int fill, const Device::Memory& out) {
    device_->run("find_neighbours", groups_, reference_, kind_, types_, tables_, last_, cell_, first_, member_,
                 reach, elements_, stride_, buckets_, fill, begin_, out);
  };
  find(0, counts_);
  count.resize(n);
  device_->read(counts_, count.data(), n * sizeof(int));
  sum = sums_of(count);
  device_->write(begin_, sum.data(), sum.size() * sizeof(int));
  listed_ = static_cast<std::size_t>(sum.back());
  if (listed_ > room_) {
    bytes_ -= room_ * sizeof(int);
    room_ = listed_ + listed_ / 8;
    list_ = allocate(room_ * sizeof(int));
  }
  find(1, list_);
}

DeviceStepper::Neighbours DeviceStepper::neighbours() const {
  Neighbours out{std::vector<int>(static_cast<std::size_t>(elements_) + 1, 0), std::vector<int>(listed_)};
  if (!interaction_.law) return out;
  device_->read(begin_, out.begin.data(), out.begin.size() * sizeof(int));
  device_->read(list_, out.neighbour.data(), listed_ * sizeof(int));
  return out;
}

void DeviceStepper::kick(double dt) {
  device_->run("kick", groups_, force_, kind_, types_, dt, elements_, stride_, motion_);
}

void DeviceStepper::drift(double dt, const State& s, const NeighbourList& list) {
  const int count = static_cast<int>(hosted_.size());
  const auto columns = columns_of(s);
  for (std::size_t k = 0; k < hosted_.size(); ++k)
    for (std::size_t c = 0; c < columns.size(); ++c)
      rows_[columns.size() * k + c] = (*columns[c])[static_cast<std::size_t>(hosted_[k])];
  device_->write_later(hosted_motion_, rows_.data(), 13 * hosted_.size() * sizeof(double));
  device_->run("put_motion", (count + GROUP - 1) / GROUP, which_, hosted_motion_, count, stride_, motion_);
  const TwistOfAll& of = list.common_twist();
  const TwistSince twist{of.x, of.y, of.middle, of.sine, of.slope, TwistOfAll::most, list.lever};
  device_->run("drift", groups_, motion_, kind_, reference_, twist, dt, 1 / unit_, elements_, stride_, centre_,
               axis_, velocity_, spin_, told_);
}

DeviceStepper::StepSummary DeviceStepper::compute(Forces& forces) {
  const int count = static_cast<int>(hosted_.size());
  if (interaction_.law) {
    constexpr int per_group = GROUP / LANES;
    device_->run("line_contact", (elements_ + per_group - 1) / per_group, centre_, axis_, begin_, list_, tables_,
                 elements_, contact_force_, contact_torque_);
    const ContactViscosity& v = interaction_.damping.contact;
    if (v.eta > 0) {
      const auto f = [](double x) { return static_cast<float>(x); };
      const Viscosity law{f(v.eta), f(v.inner), f(v.outer), f(1 / (v.outer - v.inner)), f(unit_)};
      device_->run("viscosity", groups_, centre_, velocity_, spin_, begin_, list_, law, elements_, contact_force_,
                   contact_torque_);
    }
  }
  device_->run("bonds", groups_, motion_, kind_, types_, interaction_.damping.bond.rate, elements_, stride_, bond_,
               told_);
  device_->run("collect", groups_, bond_, kind_, contact_force_, contact_torque_, elements_, stride_, force_,
               told_);
  device_->run("summary", groups_, told_, elements_, stride_, groups_, summary_);
  const int before = SUMMARY * groups_;
  device_->run("get_force", (count + GROUP - 1) / GROUP, force_, which_, count, stride_, before, summary_);
  device_->read(summary_, sums_.data(), sums_.size() * sizeof(double));
  for (std::size_t k = 0; k < hosted_.size(); ++k) {
    const double* const f = sums_.data() + before + 6 * k;
    forces.force.set(static_cast<std::size_t>(hosted_[k]), {f[0], f[1], f[2]});
    forces.torque.set(static_cast<std::size_t>(hosted_[k]), {f[3], f[4], f[5]});
  }
  StepSummary summary;
  int slips = NO_ELEMENT;
  for (int g = 0; g < groups_; ++g) {
    const auto of = [&](int c) { return sums_[static_cast<std::size_t>(c * groups_ + g)]; };
    summary.fastest.speed2 = std::max(summary.fastest.speed2, of(TOLD_SPEED2));
    summary.fastest.spin2 = std::max(summary.fastest.spin2, of(TOLD_SPIN2));
    summary.fastest.sum += of(SUM_SPEEDS);
    summary.change = both(summary.change, {of(TOLD_MOVED), of(SUM_MOVED), of(TOLD_TURN), of(TOLD_TURN_Z)});
    summary.damping_power += of(TOLD_POWER);
    slips = std::min(slips, static_cast<int>(of(TOLD_SLIPS)));
  }
  if (!std::isfinite(summary.change.sum)) summary.change.moved = std::numeric_limits<double>::infinity();
  if (slips != NO_ELEMENT) summary.slipping_bond = slips;
  return summary;
}

void DeviceStepper::give_places(State& s) const {
  const auto n = static_cast<std::size_t>(stride_);
  std::vector<double> numbers(7 * n);
  device_->read(motion_, numbers.data(), numbers.size() * sizeof(double));
  const auto columns = columns_of(s);
  for (std::size_t c = 0; c < 7; ++c)
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(c * n), elements_, columns[c]->begin());
}

void DeviceStepper::give(State& s, Forces& forces) const {
  const auto n = static_cast<std::size_t>(stride_);
  std::vector<double> motion(13 * n), force(6 * n);
  device_->read(motion_, motion.data(), motion.size() * sizeof(double));
  device_->read(force_, force.data(), force.size() * sizeof(double));
  std::vector<char> here(static_cast<std::size_t>(elements_), 0);
  for (const int i : hosted_) here[static_cast<std::size_t>(i)] = 1;
  const auto columns = [&](const std::vector<double>& numbers, const auto& all) {
    for (std::size_t c = 0; c < all.size(); ++c)
      for (std::size_t i = 0; i < here.size(); ++i)
        if (!here[i]) (*all[c])[i] = numbers[c * n + i];
  };
  columns(motion, columns_of(s));
  columns(force, force_columns_of(forces));
}

}  // namespace ropewalk
