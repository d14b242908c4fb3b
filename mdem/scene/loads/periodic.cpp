#include "scene/loads/periodic.hpp"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "model/error.hpp"
#include "scene/key_table.hpp"
#include "scene/loads/drive_kind.hpp"
#include "scene/loads/load_kind.hpp"
#include "scene/scene.hpp"
#include "scene/schedule_rows.hpp"

namespace ropewalk {
namespace {

void read_twist(const TomlTable& t, const Scene&, PeriodicLoad& load) {
  load.twist = points_in_time(t, "twist_deg_per_nm", Bounds::range(-45, 45));
  for (Schedule::Point& p : load.twist) p.value *= units::degree;
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
           "images", 1, 1000, &PeriodicLoad::images, otherwise("4", "as many as the contact reaches"),
           "elements at each end of a tube that are images of the other end; the period is what lies between"),
       Key::custom("twist_deg_per_nm", "deg/nm", required("[[0, 0], [100, 1.5]]"),
                   "twist of the rope per length in time, [[ps, deg/nm], ...]; [[0, 0]]: none", read_twist)},
      {}};
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
  return fmt::format("periodic: a slice of an endless rope, twisted to {:.4g} deg/nm in {:.4g} ps",
                     load.twist.back().value / units::degree, lasts());
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
  if (scene.kind != "rope") refuse("[" + scene.kind + "]", "tubes must be parallel and alike; it needs a [rope]");
}

void PeriodicDrive::add_loads(const Scene& scene, const Topology& topology, const Interaction& interaction,
                              LoadsAndConstraints& loads) const {
  loads.add(load.on_tubes(topology, interaction.cutoff(), scene.path));
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
          {scene.path, 0, "load.elements"},
          fmt::format("element {} of tube {} is an image of the slice, and a load on it has no effect",
                      e - topology.tube_begin[tube], tube),
          fmt::format("name elements from {} to {}", slice.images, topology.length_of(tube) - slice.images - 1));
    }
  }
}

void PeriodicDrive::warn(const Scene&, const Topology& topology, const LoadsAndConstraints& loads,
                         std::vector<std::string>& warnings) const {
  const PeriodicLoad& slice = *loads.of<PeriodicLoad>().front();
  const int all = topology.length_of(0), own = all - 2 * slice.images;
  warnings.push_back(
      fmt::format("This is a slice of an endless rope: of the {} elements of a tube {} are its own, {:.4g} nm, and "
                  "{} at each end "
                  "are images. Energies in eV count the images too; energies per mass, torque and tension are "
                  "those of the rope.",
                  all, own, slice.period(), slice.images));
}

// --- the load --------------------------------------------------------------------------------------------------

std::optional<LoadEffect> PeriodicLoad::effect() const {
  LoadEffect out;
  out.twist = schedule_.largest();
  out.ramp = schedule_.ends();
  return out;
}

PeriodicLoad PeriodicLoad::on_tubes(const Topology& topology, double reach, const std::string& path) const {
  const auto refuse = [&](const std::string& what, const std::string& remedy) -> InputError {
    return InputError({path, 0, "periodic"}, what, remedy);
  };
  PeriodicLoad out = *this;
  const TubeType& type = topology.type_of(0);
  const double a = type.element_length;
  const int needed = std::max(1, static_cast<int>(std::ceil(reach / a)));
  if (out.images == 0) out.images = needed;
  if (out.images < needed)
    throw InputError({path, 0, "periodic.images"},
                     fmt::format("is {}, and the contact reaches {:.3g} nm", images, reach),
                     fmt::format("take at least {}, or leave the key away", needed));
  const int all = topology.length_of(0);
  for (int t = 0; t < topology.tubes(); ++t)
    if (topology.length_of(t) != all || topology.type_of(t).element_length != a)
      throw refuse("needs tubes of one length", "take a [rope]");
  const int own = all - 2 * out.images;
  if (own < out.images)
    throw refuse(fmt::format("leaves {} elements between {} images at each end", std::max(0, own), out.images),
                 fmt::format("make the tubes at least {:.4g} nm long", 3 * out.images * a));
  out.period_ = own * a;
  // Twice what a torsional wave needs along the slice, so that the interior follows.
  const double wave = std::sqrt(type.bond.twist / (type.inertia / a));
  out.schedule_ = Schedule(twist, 2 * all * a / wave);
  for (int t = 0; t < topology.tubes(); ++t)
    for (int k = 0; k < out.images; ++k) {
      out.ends_[lower_end].push_back(topology.tube_begin[t] + k);
      out.ends_[upper_end].push_back(topology.tube_begin[t + 1] - 1 - k);
    }
  out.elements = out.ends_[lower_end];
  out.elements.insert(out.elements.end(), out.ends_[upper_end].begin(), out.ends_[upper_end].end());
  return out;
}

// So that the drift with these velocities leads to where the image will be.
void PeriodicLoad::follow(int image, int original, double sign, double time, double drift, State& s) const {
  const auto i = static_cast<std::size_t>(image), o = static_cast<std::size_t>(original);
  const Vector3 v = s.velocity[o], w = s.angular_velocity[o], x = s.position[o];
  const double turned = sign * period_ * schedule_.value(time + drift);
  const Eigen::Matrix3d r = about_z(turned);
  if (drift <= 0) {
    const Vector3 spin(0, 0, sign * period_ * schedule_.rate(time));
    s.velocity.set(i, r * v + spin.cross(r * x));
    s.angular_velocity.set(i, r * w + spin);
    return;
  }
  const Vector3 then = r * (x + drift * v) + Vector3(0, 0, sign * period_);
  s.velocity.set(i, (then - Vector3(s.position[i])) / drift);
  const Quaternion turned_then = Quaternion(r) * turn_by(drift * w) * s.orientation[o];
  s.angular_velocity.set(i, angle_of(turned_then * s.orientation[i].conjugate()) / drift);
}

template <class Act>
void PeriodicLoad::for_images(const Topology& topology, const Act& act) const {
  for (int t = 0; t < topology.tubes(); ++t) {
    const int begin = topology.tube_begin[t], own = topology.length_of(t) - 2 * images;
    for (int k = 0; k < images; ++k) {
      act(begin + k, begin + k + own, -1.0);
      act(begin + images + own + k, begin + images + k, 1.0);
    }
  }
}

void PeriodicLoad::constrain(const Topology& topology, double time, double ahead, State& s) const {
  for_images(topology,
             [&](int image, int original, double sign) { follow(image, original, sign, time, 2 * ahead, s); });
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
  for_images(topology, [&](int image, int original, double sign) {
    const auto i = static_cast<std::size_t>(image), o = static_cast<std::size_t>(original);
    const Eigen::Matrix3d r = about_z(sign * period_ * schedule_.value(s.time));
    s.position.set(i, r * Vector3(s.position[o]) + Vector3(0, 0, sign * period_));
    s.orientation.set(i, (Quaternion(r) * Quaternion(s.orientation[o])).normalized());
  });
}

}  // namespace ropewalk
