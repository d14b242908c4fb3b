#include "run/run_checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <type_traits>

#include "io/draft.hpp"
#include "io/files.hpp"
#include "io/frames/frames.hpp"
#include "io/running_hash.hpp"
#include "model/error.hpp"
#include "scene/missing_forces.hpp"
#include "scene/prepare.hpp"
#include "sim/contact/line/engine.hpp"
#include "version.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

constexpr const char* title = "ROPEWALK-CHECKPOINT 9 ";
constexpr std::size_t hash_length = 16, block_size = 1 << 20;

// Reads up to `count` bytes; returns how many there were before the end of the file.
std::size_t read_some(const std::string& path, int file, char* to, std::size_t count) {
  std::size_t have = 0;
  while (have < count) {
    const ssize_t n = uninterrupted([&] { return ::read(file, to + have, count - have); });
    if (n < 0) throw file_error(path, "cannot be read", errno);
    if (n == 0) break;
    have += static_cast<std::size_t>(n);
  }
  return have;
}

// Both go through the file piece by piece: a checkpoint of a million elements has 400 MB.
class Writer {
 public:
  explicit Writer(Draft& file) : file_(file) {}
  template <class T>
  void operator()(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    add({reinterpret_cast<const char*>(&value), sizeof value});
  }
  void operator()(const std::string& text) {
    (*this)(static_cast<std::uint64_t>(text.size()));
    add(text);
  }
  // Writes what is left. The hash of all.
  std::string end() {
    flush();
    return hash_.hex();
  }

 private:
  void add(std::string_view bytes) {
    if (small_.size() + bytes.size() > block_size) flush();
    if (bytes.size() > block_size)
      put(bytes);
    else
      small_ += bytes;
  }
  void flush() {
    put(small_);
    small_.clear();
  }
  void put(std::string_view bytes) {
    hash_.add(bytes);
    file_.write(bytes);
  }

  Draft& file_;
  RunningHash hash_;
  std::string small_;
};

// Reads numbers from the bytes between the present place of an open file and its end.
class Reader {
 public:
  Reader(const std::string& path, int file, std::uint64_t bytes) : path_(path), file_(file), left_(bytes) {}
  template <class T>
  void operator()(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    take(reinterpret_cast<char*>(&value), sizeof value);
  }
  void operator()(std::string& text) {
    std::uint64_t size = 0;
    (*this)(size);
    if (size > left_) ends_too_early();
    text.resize(size);
    take(text.data(), size);
  }
  void take(char* to, std::size_t count) {
    if (count > left_) ends_too_early();
    left_ -= count;
    if (read_some(path_, file_, to, count) < count) ends_too_early();
  }
  std::uint64_t left() const { return left_; }

 private:
  [[noreturn]] static void ends_too_early() { throw std::runtime_error("the checkpoint ends too early"); }

  const std::string& path_;
  int file_;
  std::uint64_t left_;
};

// One list for both ways.
template <class Archive, class Origin>
void visit_origin(Archive& archive, Origin& o) {
  archive(o.scene);
  for (auto* hashes : {&o.sets, &o.files}) {
    auto count = static_cast<std::uint64_t>(hashes->size());
    archive(count);
    if constexpr (!std::is_const_v<Origin>) hashes->resize(std::min<std::uint64_t>(count, 1000));
    for (auto& hash : *hashes) archive(hash);
  }
  for (auto* text : {&o.state, &o.version, &o.git_id, &o.instructions, &o.device, &o.own_forces}) archive(*text);
}

template <class Archive, class Checkpoint>
void visit_state(Archive& archive, Checkpoint& c) {
  for (auto* file : {&c.files.log, &c.files.frames, &c.files.events}) {
    archive(file->bytes);
    archive(file->tail_from);
    archive(file->tail);
    archive(file->step);
  }
  archive(c.first_energy);
  archive(c.energy);
  archive(c.wall_seconds);
  archive(c.control);
  archive(c.on_limit);
  archive(c.ends_for);
  archive(c.simulation);
}

RunCheckpoint state_from(Reader& read, const std::string& path) {
  RunCheckpoint c;
  std::string limits;
  visit_state(read, c);
  read(limits);
  c.limits = limits_of_text(limits, path);
  return c;
}

std::string hash_of_rest(const std::string& path, int file) {
  RunningHash hash;
  std::string block(block_size, '\0');
  while (const std::size_t count = read_some(path, file, block.data(), block.size()))
    hash.add(std::string_view(block).substr(0, count));
  return hash.hex();
}

// Empty where the file is damaged or of another version.
std::optional<RunCheckpoint> checkpoint_from(const std::string& path) {
  const Descriptor file = opened_to_read(path);
  const auto size = static_cast<std::uint64_t>(fs::file_size(path));
  const std::size_t begin = std::strlen(title), head = begin + hash_length + 1;
  std::string first(head, '\0');
  if (size <= head || read_some(path, file.get(), first.data(), head) < head || first.compare(0, begin, title) != 0 ||
      first.substr(begin, hash_length) != hash_of_rest(path, file.get()))
    return {};
  if (::lseek(file.get(), static_cast<off_t>(head), SEEK_SET) < 0) throw file_error(path, "cannot be read", errno);
  try {
    Reader read(path, file.get(), size - head);
    RunOrigin origin;
    visit_origin(read, origin);
    RunCheckpoint c = state_from(read, path);
    if (read.left() > 0) c.snapshot = std::make_shared<const RunCheckpoint>(state_from(read, path));
    c.origin = origin;
    return c;
  } catch (const std::runtime_error&) {
    return {};
  }
}

struct StoredCheckpoint {
  std::string path;
  std::optional<RunCheckpoint> content;  // none: damaged
};

// Reads the checkpoints that are there, the newest first, until one is as it has to be. All that were read.
std::vector<StoredCheckpoint> read_until(const RunDirectory& dir,
                                         const std::function<bool(const RunCheckpoint&)>& will_do) {
  std::vector<StoredCheckpoint> all;
  for (const std::string& path : {dir.checkpoint(), dir.checkpoint_before()}) {
    if (!fs::exists(path)) continue;
    all.push_back({path, checkpoint_from(path)});
    if (all.back().content && will_do(*all.back().content)) break;
  }
  return all;
}

std::string id_of_program() { return fmt::format("{} ({})", version, git_id); }

enum class Format { this_one, another, damaged };

Format format_of_checkpoint(const std::string& path) {
  constexpr std::size_t number = 20;  // length of "ROPEWALK-CHECKPOINT "
  std::string begin(std::strlen(title), '\0');
  begin.resize(read_some(path, opened_to_read(path).get(), begin.data(), begin.size()));
  if (begin == title) return Format::this_one;
  return begin.substr(0, number) == std::string(title).substr(0, number) ? Format::another : Format::damaged;
}

std::string version_of_run(const RunDirectory& dir) {
  try {
    const Manifest m = read_manifest(dir.manifest());
    return fmt::format("{} ({})", m.version, m.git_id);
  } catch (const InputError&) {
    return "of another version";
  }
}

void refuse_without_checkpoint(const RunDirectory& dir, const std::vector<StoredCheckpoint>& all) {
  for (const StoredCheckpoint& s : all)
    if (s.content) return;
  refuse_without_checkpoint(dir);
  throw InputError({dir.checkpoint(), 0, ""}, "is damaged", "start the run anew with `ropewalk run`");
}

std::string size_words(const std::string& path, const FileMark& mark) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (error) return "is missing";
  if (size < mark.bytes)
    return fmt::format("has {} of the {} bytes that the checkpoint knows of", size, mark.bytes);
  return fmt::format("is not what was written up to the checkpoint, at byte {}", mark.bytes);
}

// The whole frames at the begin of the file.
FileMark whole_frames(const RunDirectory& dir, std::uint64_t most) {
  std::uint64_t bytes = 0;
  if (!fs::exists(dir.frames())) return mark_of("");
  Scene scene = read_run_scene(dir);
  const Topology topology = prepare(scene).topology;
  try {
    const auto reader = open_frames(dir.frames());
    StoredFrame frame;
    while (reader->next(topology, frame) && reader->position() <= most) bytes = reader->position();
  } catch (const InputError&) {  // damaged from here on
  }
  return mark_of(dir.frames(), bytes, bytes);
}

}  // namespace

void refuse_without_checkpoint(const RunDirectory& dir) {
  if (!has_checkpoint(dir))
    throw InputError({dir.checkpoint(), 0, ""}, "there is no checkpoint", "start the run with `ropewalk run`");
  bool another = false;
  for (const std::string& path : {dir.checkpoint(), dir.checkpoint_before()}) {
    if (!fs::exists(path)) continue;
    const Format format = format_of_checkpoint(path);
    if (format == Format::this_one) return;
    another = another || format == Format::another;
  }
  if (another)
    throw InputError(
        {dir.checkpoint(), 0, ""},
        fmt::format("was written by ropewalk {}, and this is {}, which has other checkpoints", version_of_run(dir),
                    id_of_program()),
        "finish the run with that version, or begin a scene with its last state: file = \"final.csv\" in "
        "[state]");
}

RunOrigin origin_of(const RunDirectory& dir, const Scene& scene) {
  RunOrigin o;
  o.scene = scene.text;
  for (const ParameterSet& set : scene.sets) o.sets.push_back(set.hash);
  for (const std::string& file : scene.files_of_drives()) o.files.push_back(hash_hex(read_file(file)));
  if (scene.from_file()) {
    o.state = hash_hex(read_file(dir.state()));
    if (fs::exists(dir.state_memory())) o.state += hash_hex(read_file(dir.state_memory()));
  }
  o.version = version;
  o.git_id = git_id;
  o.instructions = instructions_in_use();
  return o;
}

void write_checkpoint(const RunDirectory& dir, const RunCheckpoint& checkpoint) {
  Draft file(dir.checkpoint());
  file.write(title + std::string(hash_length, '0') + "\n");
  Writer write(file);
  visit_origin(write, checkpoint.origin);
  for (const RunCheckpoint* c = &checkpoint; c; c = c->snapshot.get()) {
    visit_state(write, *c);
    write(limits_json(c->limits));
  }
  file.patch(std::strlen(title), write.end());
  file.replace_keeping(dir.checkpoint_before());
}

RunCheckpoint read_checkpoint(const RunDirectory& dir) {
  std::vector<StoredCheckpoint> all = read_until(dir, [](const RunCheckpoint&) { return true; });
  refuse_without_checkpoint(dir, all);
  return std::move(*(all.front().content ? all.front() : all.back()).content);
}

namespace {

bool reaches_events(const RunDirectory& dir, const FileMarks& marks) {
  return marks.events.bytes == 0 || reaches(dir.events(), marks.events);
}

void do_without_what_is_lost(const RunDirectory& dir, ResumePoint& point) {
  FileMarks& marks = point.checkpoint.files;
  if (!reaches(dir.frames(), marks.frames)) {
    marks.frames = whole_frames(dir, marks.frames.bytes);
    point.remarks.push_back(marks.frames.bytes == 0
                                ? "frames begin anew here; those before are lost"
                                : "frames go on behind the last whole one; those between are lost");
  }
  if (!reaches_events(dir, marks)) {
    marks.events = {};
    point.remarks.push_back("events begin anew here; those before are lost");
  }
  if (!point.checkpoint.snapshot) return;
  RunCheckpoint snapshot = *point.checkpoint.snapshot;
  if (snapshot.files.frames.bytes > marks.frames.bytes) snapshot.files.frames = marks.frames;
  if (snapshot.files.events.bytes > marks.events.bytes) snapshot.files.events = marks.events;
  point.checkpoint.snapshot = std::make_shared<const RunCheckpoint>(std::move(snapshot));
}

}  // namespace

ResumePoint find_resume_point(const RunDirectory& dir) {
  std::vector<StoredCheckpoint> all = read_until(dir, [&](const RunCheckpoint& c) {
    return reaches(dir.log(), c.files.log) && reaches(dir.frames(), c.files.frames) && reaches_events(dir, c.files);
  });
  refuse_without_checkpoint(dir, all);
  ResumePoint out;
  StoredCheckpoint *with_all = nullptr, *with_log = nullptr, *newest = nullptr;
  for (StoredCheckpoint& s : all) {
    if (!s.content) {
      out.remarks.push_back(fmt::format("{} is damaged", s.path));
      continue;
    }
    if (!newest) newest = &s;
    const FileMarks& marks = s.content->files;
    const bool log = reaches(dir.log(), marks.log), frames = reaches(dir.frames(), marks.frames),
               events = reaches_events(dir, marks);
    if (log && !with_log) with_log = &s;
    if (log && frames && events && !with_all) with_all = &s;
    for (const auto& [path, whole, mark] :
         {std::tuple{dir.log(), log, marks.log}, std::tuple{dir.frames(), frames, marks.frames},
          std::tuple{dir.events(), events, marks.events}})
      if (!whole && newest == &s) out.remarks.push_back(fmt::format("{} {}", path, size_words(path, mark)));
    if (with_all) break;
  }
  StoredCheckpoint* const chosen = with_all ? with_all : with_log;
  if (!chosen)
    throw InputError({dir.log(), 0, ""}, size_words(dir.log(), newest->content->files.log),
                     "bring it back from a copy, or start the run anew with `ropewalk run`");
  out.path = chosen->path;
  out.checkpoint = std::move(*chosen->content);
  if (chosen != &all.front())
    out.remarks.push_back(fmt::format("the run goes on from the checkpoint before, {}", chosen->path));
  if (with_all) return out;
  do_without_what_is_lost(dir, out);
  return out;
}

Simulation simulation_at(const RunDirectory& dir, const Scene& scene, const Prepared& p, const RunCheckpoint& c) {
  refuse_missing_forces(c.origin.own_forces, dir.path);
  Simulation s = start(scene, p);
  try {
    s.restore(c.simulation);
  } catch (const std::runtime_error& e) {
    throw InputError({dir.checkpoint(), 0, ""}, e.what(), "start the run anew with `ropewalk run`");
  }
  return s;
}

}  // namespace ropewalk
