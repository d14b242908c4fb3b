#include "fuzz/targets.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string_view>

#include "atomistic/stiffness.hpp"
#include "atoms/potential.hpp"
#include "campaign/sweep_file.hpp"
#include "chart/point.hpp"
#include "io/files.hpp"
#include "io/frames/frames.hpp"
#include "io/limits_file.hpp"
#include "io/log.hpp"
#include "io/manifest.hpp"
#include "io/numeric_errors.hpp"
#include "io/parameters_toml.hpp"
#include "io/run_errors.hpp"
#include "model/error.hpp"
#include "run/events_file.hpp"
#include "run/run_checkpoint.hpp"
#include "run/run_directory.hpp"
#include "scene/lammps_files.hpp"
#include "scene/lammps_states.hpp"
#include "scene/prepare.hpp"
#include "scene/scene_toml.hpp"
#include "scene/state_csv.hpp"
#include "verbs/tables.hpp"
#include "verbs/verbs.hpp"

namespace ropewalk::fuzz {

File::File(const std::string& bytes) : descriptor_(memfd_create("input", 0)) {
  path_ = "/proc/self/fd/" + std::to_string(descriptor_);
  if (descriptor_ < 0 || ::write(descriptor_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("no memory for an input");
}
File::~File() { ::close(descriptor_); }

std::string directory() {
  static const std::string made = [] {
    const char* memory = "/dev/shm";
    const std::filesystem::path in =
        std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
    std::string pattern = (in / "ropewalk-fuzz-XXXXXX").string();
    if (!::mkdtemp(pattern.data())) throw std::runtime_error("no directory for inputs");
    return pattern;
  }();
  static const struct Cleaner {
    ~Cleaner() { std::filesystem::remove_all(made); }
  } cleaner;
  return made;
}

void write(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

namespace {

template <class Read>
void taken_or_refused(const Read& read) {
  try {
    read();
  } catch (const InputError&) {
  } catch (const NumericalError&) {
  }
}

std::string set_file() { return ROPEWALK_SOURCE_DIR "/data/parameters/cnt-10-10-tersoff.toml"; }

Topology short_tubes() {
  static const ParameterSet set = read_parameters(set_file());
  Topology t;
  TubeType type;
  type.element_length = set.element_length;
  type.radius = set.radius;
  t.types = {type};
  t.add_tube(2);
  t.add_tube(3);
  return t;
}

// --- Scenes and what they name ---

constexpr double most_elements = 300;  // of a scene that is prepared as well

void scene(const std::string& bytes) {
  taken_or_refused([&] {
    Scene read = scene_of_text(bytes, "scene.toml", {set_file()});
    const Source::Sizes sizes = read.source->sizes(read.element_length);
    const double elements = double{1} * sizes.tubes * sizes.elements;
    if (elements >= 1 && elements <= most_elements) prepare(read);
  });
}

void parameters(const std::string& bytes) {
  taken_or_refused([&] {
    const ParameterSet set = parameters_of_text(bytes, "set.toml");
    // The text that is written of a set is a set again.
    parameters_of_text(parameters_text(set, ""), "again.toml");
  });
}

void state(const std::string& bytes) {
  const File file(bytes);
  taken_or_refused([&] {
    Topology topology = short_tubes();
    State s;
    read_state_csv(file.path(), topology, s);
  });
}

void sweep(const std::string& bytes) {
  taken_or_refused([&] {
    const Sweep read =
        sweep_of_text(bytes, "sweep.toml", ROPEWALK_SOURCE_DIR "/tests/fuzz/corpus/scene/chain.toml");
    double points = 1;
    for (const SweepAxis& axis : read.axes) points *= static_cast<double>(axis.values.size());
    for (const SweepAxis& axis : read.branch_axes) points *= static_cast<double>(axis.values.size());
    if (points <= 4) points_of(read);
  });
}

// --- Files of a run ---

Simulation& small_simulation() {
  static Simulation made = [] {
    Scene s = read_scene(ROPEWALK_SOURCE_DIR "/tests/fuzz/corpus/scene/rope.toml", {set_file()});
    const Prepared p = prepare(s);
    return start(s, p);
  }();
  return made;
}

// An input is a list of changes to a valid file. A change has twelve bytes: a position, and the eight bytes to put
// there. So stored inputs remain useful when the format changes, and they test more than the head of the file.
std::string changed(std::string file, std::string_view changes) {
  while (changes.size() >= 12 && !file.empty()) {
    std::uint32_t at = 0;
    std::memcpy(&at, changes.data(), sizeof at);
    at %= static_cast<std::uint32_t>(file.size());
    const std::string_view value = changes.substr(4, 8);
    file.replace(at, std::min<std::size_t>(8, file.size() - at), value.substr(0, file.size() - at));
    changes.remove_prefix(12);
  }
  // A byte that is left over says where the end is cut off.
  return changes.empty() ? file : file.substr(0, file.size() * static_cast<unsigned char>(changes[0]) / 256);
}

void relax_a_little(Simulation& s) {
  int steps = 0;
  s.relax(RelaxGoal(), std::numeric_limits<long>::max(), [&](long) { return steps++ < 2; });
}

// In the middle of a relaxation. restore() throws std::runtime_error, which its callers turn into words.
void checkpoint(const std::string& bytes) {
  Simulation& s = small_simulation();
  static const std::string genuine = [&s] {
    relax_a_little(s);
    return s.serialise();
  }();
  try {
    s.restore(changed(genuine, bytes));
    relax_a_little(s);
    s.steps(2);
  } catch (const NumericalError&) {
  } catch (const std::runtime_error& e) {
    if (std::string(e.what()).find("checkpoint") == std::string::npos) throw;
  }
}

// The file around it, with a checksum that fits.
void run_checkpoint(const std::string& bytes) {
  static const RunDirectory dir{directory()};
  static const std::string genuine = [] {
    RunCheckpoint c;
    c.simulation = "not looked into";
    c.snapshot = std::make_shared<const RunCheckpoint>(c);
    write_checkpoint(dir, c);
    return read_file(dir.checkpoint());
  }();
  const std::size_t body = genuine.find('\n') + 1;
  std::string file = genuine.substr(0, body) + changed(genuine.substr(body), bytes);
  file.replace(body - 17, 16, hash_hex(std::string_view(file).substr(body)));
  write(dir.checkpoint(), file);
  taken_or_refused([&] { read_checkpoint(dir); });
}

void read_frames(const std::string& path) {
  taken_or_refused([&] {
    const auto reader = open_frames(path);
    StoredFrame frame;
    while (reader->next(short_tubes(), frame)) {
    }
  });
}

void dump(const std::string& bytes) {
  const File file(bytes);
  read_frames(file.path());
}

// Changes of two whole frames.
void gsd(const std::string& bytes) {
  static const std::string genuine = [] {
    const std::string path = directory() + "/genuine.gsd";
    const auto writer = frame_writer(path, FrameFormat::gsd, 0, 0);
    const State state(static_cast<std::size_t>(short_tubes().elements()));
    for (int k = 0; k < 2; ++k) writer->write(short_tubes(), state, {});
    return read_file(path);
  }();
  const File file(changed(genuine, bytes));
  read_frames(file.path());
}

void manifest(const std::string& bytes) {
  const File file(bytes);
  taken_or_refused([&] { manifest_json(read_manifest(file.path())); });
}

// The two files of errors.
void run_errors(const std::string& bytes) {
  const std::string run = directory();
  std::filesystem::create_directories(run + "/errors");
  const std::vector<LogRow> log(1);
  for (const char* name : {"errors.json", "numerics.json"}) {
    write(run + "/errors/" + name, bytes);
    taken_or_refused([&] { rows_of_errors(run, log); });
    std::filesystem::remove(run + "/errors/" + name);
  }
}

void limits(const std::string& bytes) {
  const File file(bytes);
  taken_or_refused([&] { limits_json(read_limits(file.path())); });
}

void events(const std::string& bytes) {
  const File file(bytes);
  taken_or_refused([&] {
    const StoredEvents events(file.path(), small_simulation().topology());
    events.tubes_at(1);
    events.links_at(1);
  });
}

void log(const std::string& bytes) {
  const File file(bytes);
  taken_or_refused([&] { read_log(file.path()); });
}

// --- What LAMMPS leaves ---

void lammps_states(const std::string& bytes) {
  const File file(bytes);
  taken_or_refused([&] {
    const Topology topology = short_tubes();
    LammpsStates states(file.path(), topology);
    State s;
    Vec3Array force, torque;
    while (states.next(s, force, torque)) {
    }
  });
}

// One input is all three small files, so that a corpus is one folder.
void lammps_tables(const std::string& bytes) {
  const LammpsDirectory dir{directory()};
  for (const std::string& path : {dir.rows(), dir.start(), dir.tubes()}) write(path, bytes);
  taken_or_refused([&] { read_lammps_rows(dir); });
  taken_or_refused([&] { start_json(read_start(dir)); });
  taken_or_refused([&] {
    Topology topology = short_tubes();
    read_tubes(dir, topology);
  });
}

// --- Calibration and validation ---

void chart(const std::string& bytes) {
  const File file(bytes);
  taken_or_refused([&] { point_json(validate::read_point(file.path())); });
}

void contact_table(const std::string& bytes) {
  const File file(bytes);
  taken_or_refused([&] { calibrate::read_contact_csv(file.path()); });
}

void stiffness_table(const std::string& bytes) {
  const File file(bytes);
  taken_or_refused([&] {
    calibrate::AtomisticOrigin origin;
    const std::vector<calibrate::AtomisticRow> rows = calibrate::read_atomistic_csv(file.path(), &origin);
    const File again(calibrate::atomistic_csv(rows, origin));
    calibrate::read_atomistic_csv(again.path());
  });
}

// The table has one energy, fewer than there are unknowns: all settings are read, and nothing is fitted.
void settings(const std::string& bytes) {
  const File file(bytes);
  taken_or_refused([&] {
    calibrate::FitArguments a;
    a.data = ROPEWALK_SOURCE_DIR "/tests/fuzz/corpus/stiffness_table/one-row.csv";
    a.settings = file.path();
    calibrate::fit_command(a);
  });
}

void potential(const std::string& bytes) {
  const File file(bytes);
  taken_or_refused([&] { user_potential(file.path()); });
}

}  // namespace

const std::vector<Target>& targets() {
  static const std::vector<Target> all = {{"scene", scene},
                                          {"parameters", parameters},
                                          {"state", state},
                                          {"sweep", sweep},
                                          {"checkpoint", checkpoint},
                                          {"run_checkpoint", run_checkpoint},
                                          {"gsd", gsd},
                                          {"dump", dump},
                                          {"manifest", manifest},
                                          {"events", events},
                                          {"limits", limits},
                                          {"run_errors", run_errors},
                                          {"log", log},
                                          {"lammps_states", lammps_states},
                                          {"lammps_tables", lammps_tables},
                                          {"chart", chart},
                                          {"contact_table", contact_table},
                                          {"stiffness_table", stiffness_table},
                                          {"settings", settings},
                                          {"potential", potential}};
  return all;
}

}  // namespace ropewalk::fuzz
