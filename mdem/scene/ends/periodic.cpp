#include "scene/ends/periodic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "model/error.hpp"
#include "model/yarn.hpp"
#include "scene/drive_kind.hpp"
#include "scene/key_table.hpp"
#include "scene/kinds/rope.hpp"
#include "scene/loads/load_kind.hpp"
#include "scene/scene.hpp"
#include "scene/scene_place.hpp"
#include "scene/schedule_rows.hpp"
#include "scene/spacing.hpp"

namespace ropewalk {
namespace {

constexpr double per_m = 1e-9, um = 1e3;  // 1/nm, nm

void read_twist(const TomlTable& t, const Scene&, PeriodicLoad& load) {
  if (!t.has("twist_deg_per_nm")) return;
  load.twist = points_in_time(t, "twist_deg_per_nm", Bounds::range(-45, 45));
  for (Schedule::Point& p : load.twist) p.value *= units::degree;
}

void read_turns(const TomlTable& t, const Scene&, PeriodicLoad& load) {
  if (!t.has("turns_per_m")) return;
  load.turns = points_in_time(t, "turns_per_m", Bounds::range(-1e9, 1e9));
  for (Schedule::Point& p : load.turns) p.value *= per_m;
}

void read_strain(const TomlTable& t, const Scene&, PeriodicLoad& load) {
  if (t.has("strain")) load.strain = points_in_time(t, "strain", Bounds::range(-0.5, 1));
}

void read_tension(const TomlTable& t, const Scene&, PeriodicLoad& load) {
  if (!t.has("tension_nN")) return;
  load.tension = points_in_time(t, "tension_nN", Bounds::range(-1e6, 1e6));
  for (Schedule::Point& p : load.tension) p.value *= units::nN_nm;
}

void check_turns(const TomlTable& t, const PeriodicLoad& load) {
  if (t.has("turns_per_m") == t.has("twist_deg_per_nm"))
    throw t.error("twist_deg_per_nm",
                  t.has("turns_per_m") ? "stands beside turns_per_m, which says the same of a yarn" : "is missing",
                  "give twist_deg_per_nm, or turns_per_m and yarn_diameter_um");
  if (load.turns.empty()) return;
  if (!(load.yarn_diameter > 0))
    throw t.error("yarn_diameter_um", "is missing", "turns_per_m needs it: the angle is that of a yarn so thick");
  for (const Schedule::Point& p : load.turns)
    if (const double steep = std::fabs(yarn_slope(p.value, load.yarn_diameter)); steep > 1)
      throw t.error("turns_per_m",
                    fmt::format("lays the surface of the yarn at {:.3g} degrees to its axis",
                                std::atan(steep) / units::degree),
                    fmt::format("at most 45 degrees, {:.4g} turns per metre, can be built",
                                1 / yarn_slope(per_m, load.yarn_diameter)));
}

void check_slice(const TomlTable& t, const Scene&, PeriodicLoad& load) {
  check_turns(t, load);
  if (load.strain.empty() || load.strain.front().value == 0) return;
  throw t.error("strain", fmt::format("begins with {:.4g}", load.strain.front().value),
                "begin with 0: it counts from the length at that time on");
}

constexpr double slack = 0.5;  // part of an element; at so much distance the contact is weak

// Images that a slice needs at each end, for a contact that reaches so many elements far: shortened, it has more of
// them within reach.
int images_within(double reach, double least_strain) {
  const double shortened = (reach - 0.9 * slack) / (1 + std::min(least_strain, 0.0));
  return std::max(1, static_cast<int>(std::ceil(std::max(reach, shortened))));
}

double least_of(const std::vector<Schedule::Point>& points) {
  double least = 0;
  for (const Schedule::Point& p : points) least = std::min(least, p.value);
  return least;
}

Eigen::Matrix3d about_z(double angle) { return Eigen::AngleAxisd(angle, Vector3::UnitZ()).toRotationMatrix(); }

Quaternion turn_by(const Vector3& angle) {
  const double size = angle.norm();
  return size > 0 ? Quaternion(Eigen::AngleAxisd(size, angle / size)) : Quaternion::Identity();
}

Vector3 angle_of(Quaternion q) {
  if (q.w() < 0) q.coeffs() *= -1;
  const double sine = q.vec().norm();
  return sine > 0 ? Vector3(2 * std::atan2(sine, q.w()) / sine * q.vec()) : Vector3::Zero();
}

const KeyTable<PeriodicLoad>& periodic_table() {
  using Key = KeyOf<PeriodicLoad>;
  static const KeyTable<PeriodicLoad> table = {
      "periodic",
      "the interior of a long rope: a slice that goes on at both ends as its own image; without this table, a "
      "whole rope",
      {Key::integer(
           "images", 1, 1000, &PeriodicLoad::images,
           otherwise("4",
                     "as many as the contact reaches, also at the least strain; where tubes end inside, 5 nm and a "
                     "tenth of a tube more"),
           "elements at each end of a tube that are images of the other end; the period is what lies between"),
       Key::custom("twist_deg_per_nm", "deg/nm", otherwise("[[0, 0], [100, 1.5]]", "required but for turns_per_m"),
                   "twist of the rope per length in time, [[ps, deg/nm], ...]; [[0, 0]]: none", read_twist)
           .of_pace(SceneKey::Pace::course),
       Key::custom("turns_per_m", "1/m", otherwise("[[0, 0], [100, 2000]]", "twist_deg_per_nm"),
                   "in place of twist_deg_per_nm: turns per metre of a yarn against time; the outermost tubes of "
                   "the slice get the angle of its surface",
                   read_turns)
           .of_pace(SceneKey::Pace::course),
       Key::number("yarn_diameter_um", {"um", um}, Bounds::positive(1e6), &PeriodicLoad::yarn_diameter,
                   otherwise("20", "none"), "diameter of that yarn; reports name turns per metre for it"),
       Key::custom("strain", "", otherwise("[[100, 0], [300, 0.02]]", "none"),
                   "strain of the slice against time, [[ps, strain], ...], from the first of these times on",
                   read_strain)
           .of_pace(SceneKey::Pace::course),
       Key::custom(
           "tension_nN", "nN", otherwise("[[0, 0]]", "the slice keeps its length"),
           "tension of the rope against time, until strain begins; until then the length of the slice is free",
           read_tension)
           .of_pace(SceneKey::Pace::course)},
      check_slice};
  return table;
}

}  // namespace

// --- the drive -------------------------------------------------------------------------------------------------

DriveKind periodic_drive() {
  return {[] { return periodic_table().doc(); },
          [](const TomlTable& t, const Scene& scene) -> std::shared_ptr<const Drive> {
            auto drive = std::make_shared<PeriodicDrive>();
            drive->load = periodic_table().read(t, scene);
            return drive;
          }};
}

SceneTable PeriodicDrive::table() const { return periodic_table().doc(); }

std::string PeriodicDrive::words() const {
  std::string text = "periodic: a slice of an endless rope, twisted ";
  if (load.turns.empty())
    text += fmt::format("to {:.4g} deg/nm in {:.4g} ps", load.twist.back().value / units::degree,
                        load.twist.back().time);
  else
    text += fmt::format(
        "to {:.4g} degrees at its surface in {:.4g} ps, as a yarn of {:.4g} um is by {:.4g} turns per metre",
        std::atan(yarn_slope(load.turns.back().value, load.yarn_diameter)) / units::degree, load.turns.back().time,
        load.yarn_diameter / um, load.turns.back().value / per_m);
  if (!load.tension.empty()) {
    Schedule pull(load.tension);
    text += fmt::format(", its length free under {:.4g} nN{}", pull.last() / units::nN_nm,
                        load.strain.empty() ? "" : fmt::format(" until {:.4g} ps", load.strain.front().time));
  }
  if (!load.strain.empty())
    text += fmt::format(", drawn out to a strain of {:.4g} in {:.4g} ps", load.strain.back().value,
                        load.strain.back().time - load.strain.front().time);
  return text;
}

void PeriodicDrive::refuse(const TomlTable& top, const Scene& scene) const {
  const auto refuse = [&](const std::string& table, const char* why) {
    throw top.table("periodic")
        .error("", fmt::format("does not go with {}: {}", table, why), "take one of the two away");
  };
  for (const auto& drive : scene.drives) {
    if (drive->ends() == Ends::loaded)
      refuse(drive->table().header(),
             "the slice has no ends; give twist_deg_per_nm, and read the torque in the log");
    if (drive->ends() == Ends::clamped) refuse(drive->table().header(), "the slice has no ends to be clamped");
  }
  if (scene.run.mode == RunOptions::Mode::relax && scene.run.solver == RunOptions::Solver::fire)
    throw top.table("periodic")
        .error("", "does not go with run.solver = \"fire\": forces on images are not those of a slice's energy",
               "take solver = \"newton\", or mode = \"dynamics\"");
  if (scene.kind != "rope") refuse("[" + scene.kind + "]", "tubes must be parallel and alike; it needs a [rope]");
  const auto* rope = dynamic_cast<const RopeSource*>(scene.source.get());
  if (load.turns.empty() || !rope) return;
  const TomlTable table = top.table("periodic");
  const char* remedy = "give twist_deg_per_nm";
  if (rope->draws_together(scene.sets.size() > 1))
    throw table.error("turns_per_m", "needs the radius of the rope, and the tubes of this one first move together",
                      remedy);
  if (rope->tubes == 1)
    throw table.error("turns_per_m",
                      "needs the angle of outermost tubes: a single tube has no angle at its surface", remedy);
}

namespace {

// Distance of the axes of the outermost tubes from that of the rope, nm.
double rim_of(const Scene& scene, const Interaction& interaction) {
  const auto* rope = dynamic_cast<const RopeSource*>(scene.source.get());
  if (!rope) return 0;
  const double spacing =
      rope->typed_spacing() > 0 ? rope->typed_spacing() : parallel_spacing(scene, interaction.law.get());
  double rim = 0;
  for (const auto& [x, y] : rope->places(spacing, scene.start.seed)) rim = std::max(rim, std::hypot(x, y));
  return rim;
}

}  // namespace

void PeriodicDrive::add_loads(const Scene& scene, const Topology& topology, const Interaction& interaction,
                              LoadsAndConstraints& loads) const {
  const double rim = load.turns.empty() ? 0 : rim_of(scene, interaction);
  loads.add(load.on_tubes(topology, interaction.cutoff(), rim, place_in(scene, "periodic.images")));
}

// Refuses loads on images: an image moves with its original, whatever load acts on the image.
void PeriodicDrive::refuse_start(const Scene& scene, const Topology& topology, const State&,
                                 const LoadsAndConstraints& loads) const {
  const PeriodicLoad& slice = *loads.of<PeriodicLoad>().front();
  const std::set<int> images(slice.elements.begin(), slice.elements.end());
  for (const LoadDrive* drive : scene.drives_of<LoadDrive>()) {
    if (drive->on.all_elements) continue;
    for (const int e : selected_elements(scene, drive->on, topology)) {
      if (images.count(e) == 0) continue;
      const int tube = topology.tube_of(e);
      throw InputError(
          place_in(scene, "load.elements"),
          fmt::format("element {} of tube {} is an image of the slice, and a load on it has no effect",
                      e - topology.tube_begin[tube], tube),
          topology.strands() < topology.tubes()
              ? fmt::format("the first and the last {} elements of each strand are images", slice.images)
              : fmt::format("name elements from {} to {}", slice.images,
                            topology.length_of(tube) - slice.images - 1));
    }
  }
}

void PeriodicDrive::warn(const Scene&, const Topology& topology, const LoadsAndConstraints& loads,
                         std::vector<std::string>& warnings) const {
  const PeriodicLoad& slice = *loads.of<PeriodicLoad>().front();
  const int all = topology.elements() / topology.strands(), own = all - 2 * slice.images;
  warnings.push_back(fmt::format(
      "This is a slice of an endless rope: of the {} elements of a {} {} are its own, {:.4g} nm, and "
      "{} at each end "
      "are images. Energies in eV and twists from end to end count the images too; energies per mass, torque and "
      "tension are "
      "those of the rope.",
      all, topology.strands() < topology.tubes() ? "strand" : "tube", own, slice.period(), slice.images));
}

// --- the load --------------------------------------------------------------------------------------------------

std::optional<LoadEffect> PeriodicLoad::effect() const {
  LoadEffect out;
  out.axes[LoadEffect::about_z] =
      LoadComponent::follows(LoadComponent::Is::moved, sum_of({{period_, schedule_}}), false);
  if (!strain.empty())
    out.axes[LoadEffect::z] =
        LoadComponent::follows(LoadComponent::Is::moved, sum_of({{period_, Schedule(strain)}}), false);
  else if (!tension.empty())
    out.axes[LoadEffect::z] = LoadComponent::follows(LoadComponent::Is::loaded, Schedule(tension), false);
  else
    out.axes[LoadEffect::z] = LoadComponent::held(false);
  out.by = LoadEffect::By::body;
  out.between_ends = true;
  return out;
}

std::string PeriodicLoad::needs_time() const {
  const bool moves = !Schedule(twist).constant() || !Schedule(strain).constant() || !Schedule(tension).constant();
  return moves ? "the images of a periodic slice follow it in time" : "";
}

std::vector<int> PeriodicLoad::reads(const Topology& topology) const {
  std::vector<int> originals;
  for (const int image : elements) originals.push_back(topology.original_of(image));
  return originals;
}

double PeriodicLoad::lasts() const {
  double last = (turns.empty() ? twist : turns).back().time;
  for (const auto* points : {&strain, &tension})
    if (!points->empty()) last = std::max(last, points->back().time);
  return last;
}

int PeriodicDrive::images(double reach) const {
  return load.images > 0 ? load.images : images_within(reach, least_of(load.strain));
}

PeriodicLoad PeriodicLoad::on_tubes(const Topology& topology, double reach, double rim,
                                    const InputError::Place& images_key) const {
  PeriodicLoad out = *this;
  if (!turns.empty()) {
    ROPEWALK_EXPECTS(rim > 0);
    out.twist = turns;
    for (Schedule::Point& p : out.twist) p.value = yarn_slope(p.value, yarn_diameter) / rim;
  }
  const TubeType& type = topology.type_of(0);
  const double a = type.element_length;
  double stiffness = 0;  // stiffness of all strands, eV/nm
  for (int s = 0; s < topology.strands(); ++s)
    stiffness += topology
                     .type_of(topology.groups.strand_begin.empty()
                                  ? s
                                  : topology.groups.strand_begin[static_cast<std::size_t>(s)])
                     .bond.stretch;
  const double strain_of_pressure = least_of(tension) / stiffness,
               least = std::min(least_of(strain), strain_of_pressure);
  out.images = topology.groups.images;
  ROPEWALK_EXPECTS(out.images > 0 && topology.elements() % topology.strands() == 0);
  if (const int needed = images_within(reach / a, least); out.images < needed)
    throw InputError(
        images_key,
        fmt::format("is {}, and the contact reaches {:.3g} nm{}", out.images, reach,
                    needed > images_within(reach / a, 0)
                        ? fmt::format(", {} elements of a slice at its least strain, {:.3g}", needed, least)
                        : ""),
        fmt::format("take at least {}{}", needed,
                    images > 0 && least == least_of(strain) ? ", or leave the key away" : ""));
  const int all = topology.elements() / topology.strands();
  out.period_ = topology.groups.period;
  out.reach_ = reach;
  // Twice what a wave needs along the period, so that the interior follows, however many images there are.
  const double twist_wave = std::sqrt(type.bond.twist / (type.inertia / a)),
               stretch_wave = std::sqrt(type.bond.stretch / (type.mass / a));
  out.schedule_ = Schedule(out.twist, 2 * out.period_ / twist_wave);
  if (!strain.empty()) out.stretched_ = Schedule(strain, 2 * out.period_ / stretch_wave);
  if (!tension.empty()) out.pulled_ = Schedule(tension);
  for (int first = 0; first < topology.elements(); first += all)
    for (int k = 0; k < out.images; ++k) {
      out.ends_[lower_end].push_back(first + k);
      out.ends_[upper_end].push_back(first + all - 1 - k);
    }
  out.elements = out.ends_[lower_end];
  out.elements.insert(out.elements.end(), out.ends_[upper_end].begin(), out.ends_[upper_end].end());
  return out;
}

PeriodicLoad::Length PeriodicLoad::measured(const Topology& topology, const State& s) const {
  Length sum;
  double mass = 0;
  for_images(topology, [&](int image, int original, double sign) {
    const auto i = static_cast<std::size_t>(image), o = static_cast<std::size_t>(original);
    const double m = topology.type_of_element(image).mass;
    sum.now += m * sign * (s.position.z[i] - s.position.z[o]);
    sum.rate += m * sign * (s.velocity.z[i] - s.velocity.z[o]);
    mass += m;
  });
  return {sum.now / mass, sum.rate / mass};
}

// Before all motion (sim/dynamics/loads.hpp) the schedules stand.
PeriodicLoad::When PeriodicLoad::when(double time, double ahead, const State& s) {
  const bool still = time < 0;
  return {still ? s.time : time, 2 * ahead, still};
}

// A length that no tension has moved is that of its schedule to the last digit.
PeriodicLoad::Length PeriodicLoad::length_after(const Topology& topology, const When& w, const State& s,
                                                double more) const {
  const double rate = w.still ? 0 : period_ * stretched_.rate(w.time);
  if (tension.empty()) return {period_ * (1 + stretched_.value(w.then())), rate};
  const Length now = measured(topology, s);
  if (is_free(w.time)) return {now.now + w.drift * (now.rate + more), now.rate + more};
  return {now.now + period_ * (stretched_.value(w.then()) - stretched_.value(w.time)), rate};
}

void PeriodicLoad::add_forces(const State&, double time, std::vector<PointLoad>& out) const {
  if (!is_free(time)) return;
  const double each = pulled_.value(time) / static_cast<double>(ends_[upper_end].size());
  for (const End end : {lower_end, upper_end})
    for (const int e : ends_[end])
      out.push_back({e, Vector3(0, 0, end == upper_end ? each : -each), Vector3::Zero()});
}

// Strands slide along one another. Their images must reach as far as the contact all the same, but for the slack.
void PeriodicLoad::check_reach(const Topology& topology, const State& s) const {
  const double half = slack * topology.type_of(0).element_length, far = std::numeric_limits<double>::max();
  double lowest_own = far, highest_own = -far, images_from = -far, images_to = far;
  std::size_t k = 0, first = 0;
  for_images(topology, [&](int image, int original, double sign) {
    const double z = s.position.z[static_cast<std::size_t>(image)],
                 own_z = s.position.z[static_cast<std::size_t>(original)];
    const int place = static_cast<int>(k) % images;  // from the end of the strand
    if (place == 0 && sign < 0 && z > images_from) first = k;
    if (place == 0 && sign < 0) images_from = std::max(images_from, z);
    if (place == 0 && sign > 0) images_to = std::min(images_to, z);
    if (place + 1 == images && sign < 0) highest_own = std::max(highest_own, own_z);
    if (place + 1 == images && sign > 0) lowest_own = std::min(lowest_own, own_z);
    ++k;
  });
  const double missing = std::max(images_from + reach_ - lowest_own, highest_own + reach_ - images_to) - half;
  if (missing <= 0) return;
  throw NumericalError(
      s.step, (numbers_.empty() ? elements : numbers_)[first],
      fmt::format(
          "the tubes of the slice have slid so far along one another that its images no longer reach as far as "
          "the contact, by {:.3g} nm",
          missing),
      fmt::format("take more images: periodic.images = {}",
                  // For slips of twice this size.
                  2 * images + 1 - static_cast<int>(reach_ / topology.type_of(0).element_length)),
      NumericalError::ShorterSteps::cannot_help);
}

// So that the drift with these velocities leads to where the image will be.
void PeriodicLoad::follow(int image, int original, double sign, const When& when, const Length& length,
                          State& s) const {
  const double drift = when.drift;
  const auto i = static_cast<std::size_t>(image), o = static_cast<std::size_t>(original);
  const Vector3 v = s.velocity[o], w = s.angular_velocity[o], x = s.position[o];
  const double turned = sign * period_ * schedule_.value(when.then());
  const Eigen::Matrix3d r = about_z(turned);
  if (drift <= 0) {
    const Vector3 spin(0, 0, when.still ? 0 : sign * period_ * schedule_.rate(when.time));
    s.velocity.set(i, r * v + spin.cross(r * x) + Vector3(0, 0, sign * length.rate));
    s.angular_velocity.set(i, r * w + spin);
    return;
  }
  const Vector3 then = r * (x + drift * v) + Vector3(0, 0, sign * length.now);
  s.velocity.set(i, (then - Vector3(s.position[i])) / drift);
  const Quaternion turned_then = Quaternion(r) * turn_by(drift * w) * s.orientation[o];
  s.angular_velocity.set(i, angle_of(turned_then * s.orientation[i].conjugate()) / drift);
}

template <class Act>
void PeriodicLoad::for_images(const Topology& topology, const Act& act) const {
  const std::size_t lower = ends_[lower_end].size(), all = lower + ends_[upper_end].size();
  for (std::size_t k = 0; k < all; ++k) {
    const int image = elements[k];
    act(image, numbers_.empty() ? topology.original_of(image) : elements[all + k], k < lower ? -1.0 : 1.0);
  }
}

void PeriodicLoad::lead(const Topology& topology, const When& when, const Length& length, State& s) const {
  for_images(topology,
             [&](int image, int original, double sign) { follow(image, original, sign, when, length, s); });
}

void PeriodicLoad::constrain(const Topology& topology, double time, double ahead, State& s) const {
  check_reach(topology, s);
  const When w = when(time, ahead, s);
  lead(topology, w, length_after(topology, w, s), s);
}

// The kick has moved images and originals by the forces on each, and the measured L' with them.
void PeriodicLoad::constrain_after(const Forces& total, double dt, const Topology& topology, double time,
                                   double ahead, State& s) const {
  check_reach(topology, s);
  double pull = 0, moved = 0, mass = 0;
  for_images(topology, [&](int image, int original, double sign) {
    const double on_image = total.force.z[static_cast<std::size_t>(image)];
    pull += 0.5 * sign * on_image;
    moved += sign * (on_image - total.force.z[static_cast<std::size_t>(original)]);
    mass += topology.type_of_element(image).mass;
  });
  const double more = dt * (pull / topology.groups.period_inertia - moved / mass);
  const When w = when(time, ahead, s);
  lead(topology, w, length_after(topology, w, s, more), s);
}

void PeriodicLoad::wind(State& s) const {
  const double twist = schedule_.value(s.time);
  if (twist == 0) return;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const Vector3 x = s.position[i], radial(x.x(), x.y(), 0);
    const Quaternion about(about_z(twist * x.z()));
    Quaternion q = s.orientation[i];
    if (radial.norm() > 0)
      q = Quaternion(Eigen::AngleAxisd(-std::atan(radial.norm() * twist), radial.normalized())) * q;
    s.position.set(i, about * x);
    s.orientation.set(i, (about * q).normalized());
  }
}

void PeriodicLoad::place(const Topology& topology, State& s) const {
  // At the start, and wherever no tension has moved it.
  const double length = period_ * (1 + stretched_.value(s.time));
  for_images(topology, [&](int image, int original, double sign) {
    const auto i = static_cast<std::size_t>(image), o = static_cast<std::size_t>(original);
    const Eigen::Matrix3d r = about_z(sign * period_ * schedule_.value(s.time));
    s.position.set(i, r * Vector3(s.position[o]) + Vector3(0, 0, sign * length));
    s.orientation.set(i, (Quaternion(r) * Quaternion(s.orientation[o])).normalized());
  });
}

}  // namespace ropewalk
