// A drive acts on the elements of a scene from outside: one table of its file, such as [[grip]] or [thermostat].
// Reader, model, refinement, forecasts, reports and the export to LAMMPS ask each drive through this interface, in
// one loop each. drive_kind.hpp is the register of drives.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene_key.hpp"
#include "sim/dynamics/loads.hpp"
#include "sim/dynamics/schedule.hpp"
#include "sim/dynamics/stepping.hpp"

namespace ropewalk {

struct Interaction;
struct Scene;
class TomlTable;

class Drive {
 public:
  // The ends of the tubes are free, loads act on them, clamps hold them, or there are none.
  enum class Ends { free, loaded, clamped, endless };

  virtual ~Drive() = default;

  // Its table, with the keys that this drive may have.
  virtual SceneTable table() const = 0;
  // For the user, in one line.
  virtual std::string words() const = 0;

  // Files that it was read from. A run keeps copies of them, under their names, and reads these again.
  virtual std::vector<std::string> files() const { return {}; }
  // Whether the motion depends on the number of this key in them, "friction.strength".
  virtual bool depends_on(const std::string& /*key*/) const { return true; }

  // Throws InputError if the rest of the scene, which has been read, contradicts it.
  virtual void refuse(const TomlTable& /*top*/, const Scene&) const {}
  // Why it has no meaning in a relaxation; empty: it has.
  virtual std::string needs_time() const { return ""; }
  // Whether a relaxation by load steps can follow its course (sim/statics/load_steps.hpp).
  virtual bool goes_by_load_steps() const { return false; }
  // The same drive with its forces and couples as they are in the end, for a relaxation, in which no time passes.
  // Null: they have no course.
  virtual std::shared_ptr<const Drive> at_its_end() const { return nullptr; }
  // The time, ps, after which it changes nothing.
  virtual double lasts() const { return 0; }

  // Adds its loads and constraints. Throws InputError for elements that do not exist.
  virtual void add_loads(const Scene&, const Topology&, const Interaction&, LoadsAndConstraints&) const {}
  // Adds its force terms (sim/forces/force_term.hpp), with add_term(). Throws likewise.
  virtual void add_terms(const Scene&, const Topology&, const State& /*start*/, Interaction&) const {}
  // Whether it draws random numbers while the scene moves.
  virtual bool is_random() const { return false; }
  // `lineage`: that of the scene (Scene::lineage).
  virtual void set_stepping(std::uint64_t /*lineage*/, Stepping&) const {}
  // Throws InputError if the elements at the start do not bear it; `loads` are those of all drives.
  virtual void refuse_start(const Scene&, const Topology&, const State&,
                            const LoadsAndConstraints& /*loads*/) const {}
  // Appends what the user should know before the run; a sentence or two each.
  virtual void warn(const Scene&, const Topology&, const LoadsAndConstraints&, std::vector<std::string>&) const {}

  virtual Ends ends() const { return Ends::free; }
  // The number of elements at each end of a strand that are images (TubeGroups::images), where the contact reaches
  // over so many elements.
  virtual int images(double /*reach*/) const { return 0; }
  // Whether the drive acts on single elements. A scene with shorter elements then keeps the centres of these
  // elements. The default is true for a drive that clamps or loads ends, and for a drive with a key that lists
  // elements.
  virtual bool holds_elements() const;
  // The number of elements at this end of a tube that the drive holds as one rigid piece.
  virtual int held(End /*end*/, int /*tube*/) const { return 0; }
  // The two types of tubes that its table names by the key `types`; empty: all. Null: it does not act by types. Of
  // listed drives of one kind, one that names a pair has that pair alone; two that name the same are refused.
  virtual const std::vector<int>* types() const { return nullptr; }
  // The same drive without these pairs of types, for a drive that names none. Null: it does not act by types.
  virtual std::shared_ptr<const Drive> without(const std::vector<std::pair<int, int>>& /*pairs*/) const {
    return nullptr;
  }
  // Null, if this drive is no thermostat.
  virtual const ThermostatOptions* thermostat() const { return nullptr; }

  // Why its elements cannot be split in two, and why they cannot be of any other length; empty: they can.
  virtual std::string why_not_split() const { return ""; }
  virtual std::string why_not_lengthened() const { return why_not_split(); }
  // The key that LAMMPS cannot carry, and why; without a key it carries the drive.
  struct NotForLammps {
    std::string key;     // key of the scene, or the table
    std::string reason;  // behind "is not for LAMMPS: "
  };
  virtual NotForLammps not_for_lammps() const { return {}; }
};

}  // namespace ropewalk
