#include "run/run_checkpoint.hpp"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <type_traits>

#include "io/files.hpp"
#include "io/frames/frames.hpp"
#include "model/error.hpp"
#include "scene/prepare.hpp"
#include "sim/contact/line/engine.hpp"
#include "sim/state/byte_archive.hpp"
#include "version.hpp"

namespace ropewalk {
namespace {

namespace fs = std::filesystem;

constexpr const char* title = "ROPEWALK-CHECKPOINT 8 ";
constexpr std::size_t hash_length = 16;

struct Writer : ByteWriter {
  using ByteWriter::operator();
  void operator()(const std::string& text) {
    (*this)(static_cast<std::uint64_t>(text.size()));
    bytes += text;
  }
};

struct Reader : ByteReader {
  using ByteReader::operator();
  void operator()(std::string& text) {
    std::uint64_t size = 0;
    (*this)(size);
    text = take(size);
  }
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
  for (auto* file : {&c.log, &c.frames}) {
    archive(file->bytes);
    archive(file->tail_from);
    archive(file->tail);
    archive(file->step);
  }
  archive(c.first_energy);
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

// Empty where the file is damaged or of another version.
std::optional<RunCheckpoint> checkpoint_from(const std::string& path) {
  const std::string bytes = read_file(path);
  const std::size_t begin = std::strlen(title), head = begin + hash_length + 1;
  if (bytes.size() <= head || bytes.compare(0, begin, title) != 0) return {};
  const std::string_view body = std::string_view(bytes).substr(head);
  if (bytes.substr(begin, hash_length) != hash_hex(body)) return {};
  try {
    Reader read{{body}};
    RunOrigin origin;
    visit_origin(read, origin);
    RunCheckpoint c = state_from(read, path);
    if (!read.bytes.empty()) c.snapshot = std::make_shared<const RunCheckpoint>(state_from(read, path));
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

// The checkpoints that are there, the newest first.
std::vector<StoredCheckpoint> stored_checkpoints(const RunDirectory& dir) {
  std::vector<StoredCheckpoint> all;
  for (const std::string& path : {dir.checkpoint(), dir.checkpoint_before()})
    if (fs::exists(path)) all.push_back({path, checkpoint_from(path)});
  return all;
}

std::string id_of_program() { return fmt::format("{} ({})", version, git_id); }

// That wrote a checkpoint of another format, as the manifest has it; empty: the checkpoint has the format of this
// one.
std::string other_version(const RunDirectory& dir) {
  constexpr std::size_t number = 20;  // of "ROPEWALK-CHECKPOINT "
  const std::string begin = read_file(dir.checkpoint()).substr(0, std::string(title).size());
  if (begin.substr(0, number) != std::string(title).substr(0, number) || begin == title) return "";
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
  if (all.empty())
    throw InputError({dir.checkpoint(), 0, ""}, "there is no checkpoint", "start the run with `ropewalk run`");
  if (const std::string version = other_version(dir); !version.empty())
    throw InputError(
        {dir.checkpoint(), 0, ""},
        fmt::format("was written by ropewalk {}, and this is {}, which has other checkpoints", version,
                    id_of_program()),
        "finish the run with that version, or begin a scene with its last state: file = \"final.csv\" in "
        "[state]");
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
  // Room is reserved, since a growing string takes up to twice its size.
  std::size_t room = 1 << 18;
  for (const RunCheckpoint* c = &checkpoint; c; c = c->snapshot.get()) room += c->simulation.size();
  Writer write;
  write.bytes.reserve(room);
  write.bytes += title + std::string(hash_length, '0') + "\n";
  const std::size_t head = write.bytes.size();
  visit_origin(write, checkpoint.origin);
  for (const RunCheckpoint* c = &checkpoint; c; c = c->snapshot.get()) {
    visit_state(write, *c);
    write(limits_json(c->limits));
  }
  const std::string hash = hash_hex(std::string_view(write.bytes).substr(head));
  write.bytes.replace(std::strlen(title), hash_length, hash);
  write_file_atomically(dir.checkpoint(), write.bytes, dir.checkpoint_before());
}

RunCheckpoint read_checkpoint(const RunDirectory& dir) {
  std::vector<StoredCheckpoint> all = stored_checkpoints(dir);
  refuse_without_checkpoint(dir, all);
  return std::move(*(all.front().content ? all.front() : all.back()).content);
}

ResumePoint find_resume_point(const RunDirectory& dir) {
  std::vector<StoredCheckpoint> all = stored_checkpoints(dir);
  refuse_without_checkpoint(dir, all);
  ResumePoint out;
  const StoredCheckpoint *with_all = nullptr, *with_log = nullptr, *newest = nullptr;
  for (const StoredCheckpoint& s : all) {
    if (!s.content) {
      out.remarks.push_back(fmt::format("{} is damaged", s.path));
      continue;
    }
    if (!newest) newest = &s;
    const bool log = reaches(dir.log(), s.content->log), frames = reaches(dir.frames(), s.content->frames);
    if (log && !with_log) with_log = &s;
    if (log && frames && !with_all) with_all = &s;
    for (const auto& [path, whole, mark] :
         {std::tuple{dir.log(), log, s.content->log}, std::tuple{dir.frames(), frames, s.content->frames}})
      if (!whole && newest == &s) out.remarks.push_back(fmt::format("{} {}", path, size_words(path, mark)));
    if (with_all) break;
  }
  const StoredCheckpoint* chosen = with_all ? with_all : with_log;
  if (!chosen)
    throw InputError({dir.log(), 0, ""}, size_words(dir.log(), newest->content->log),
                     "bring it back from a copy, or start the run anew with `ropewalk run`");
  out.path = chosen->path;
  out.checkpoint = *chosen->content;
  if (chosen != &all.front())
    out.remarks.push_back(fmt::format("the run goes on from the checkpoint before, {}", chosen->path));
  if (with_all) return out;
  RunCheckpoint& c = out.checkpoint;
  c.frames = whole_frames(dir, c.frames.bytes);
  if (c.snapshot && c.snapshot->frames.bytes > c.frames.bytes) {
    RunCheckpoint snapshot = *c.snapshot;
    snapshot.frames = c.frames;
    c.snapshot = std::make_shared<const RunCheckpoint>(snapshot);
  }
  out.remarks.push_back(c.frames.bytes == 0 ? "frames begin anew here; those before are lost"
                                            : "frames go on behind the last whole one; those between are lost");
  return out;
}

Simulation simulation_at(const RunDirectory& dir, const Scene& scene, const Prepared& p, const RunCheckpoint& c) {
  Simulation s = start(scene, p);
  try {
    s.restore(c.simulation);
  } catch (const std::runtime_error& e) {
    throw InputError({dir.checkpoint(), 0, ""}, e.what(), "start the run anew with `ropewalk run`");
  }
  return s;
}

}  // namespace ropewalk
