// `convert`: the frames of a run in another format.
#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "commands/verb.hpp"
#include "io/draft.hpp"
#include "io/files.hpp"
#include "io/frames/frames.hpp"
#include "io/frames/vtp.hpp"
#include "io/removal.hpp"
#include "model/error.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {
namespace {

struct ConvertArguments {
  std::string dir;
  std::string out;  // .gsd, .lammpstrj or .pvd
  double from_ps = 0;
  std::optional<double> to_ps;
  long every = 1;  // frames
  bool force = false;
};

namespace fs = std::filesystem;

// Takes frames one after another.
struct Output {
  virtual ~Output() = default;
  virtual void add(const Topology& topology, const StoredFrame& frame) = 0;
  virtual void end() = 0;
};

class FramesOutput : public Output {
 public:
  explicit FramesOutput(const std::string& path) : frames_(path, format_of(path), 0) {}
  void add(const Topology& topology, const StoredFrame& f) override {
    frames_->write(topology, f.state, f.colours);
  }
  void end() override { frames_.replace(); }

 private:
  NewFrames frames_;
};

// A PVD file and a folder of its name with the frames, which stand beside it until all are whole.
class ParaviewOutput : public Output {
 public:
  ParaviewOutput(const fs::path& pvd, bool force) : pvd_(pvd), folder_(fs::path(pvd).replace_extension("")) {
    std::error_code error;
    refuse_strange(folder_.string(), true);
    if (fs::exists(folder_, error) && !fs::is_empty(folder_, error))
      refuse_existing(folder_.string(), "FILE", force);
    const fs::path place = pvd.has_parent_path() ? pvd.parent_path() : ".";
    fs::create_directories(place, error);
    if (error) throw file_error(place.string(), "cannot be made", error.value());
    drafts_.emplace(place.string());
  }
  void add(const Topology& topology, const StoredFrame& f) override {
    const std::string name = fmt::format("frame-{:09d}.vtp", f.state.step);
    write_file_atomically(drafts_->file(name), vtp_frame(topology, f.state, f.colours));
    names_.push_back(name);
    entries_.push_back({f.state.time, (folder_.filename() / name).string()});
  }
  void end() override {
    Draft pvd(pvd_.string());
    pvd.write(pvd_text(entries_));
    pvd.sync();
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error) throw file_error(folder_.string(), "cannot be made", error.value());
    for (const std::string& name : names_) rename_whole(drafts_->file(name), (folder_ / name).string());
    pvd.replace();
  }

 private:
  fs::path pvd_, folder_;
  std::optional<TemporaryFolder> drafts_;
  std::vector<std::string> names_;
  std::vector<PvdEntry> entries_;
};

std::unique_ptr<Output> output_for(const std::string& path, bool force) {
  const std::string end = fs::path(path).extension().string();
  if (end == ".pvd") return std::make_unique<ParaviewOutput>(path, force);
  if (end == ".gsd" || end == ".lammpstrj") return std::make_unique<FramesOutput>(path);
  throw InputError({path, 0, "FILE"}, "ends in none of .gsd, .lammpstrj, .pvd",
                   "choose the format by the end of the name");
}

int convert_command(const ConvertArguments& a) {
  const RunDirectory dir{a.dir};
  const std::string from = dir.frames();
  std::error_code error;
  if (fs::equivalent(from, a.out, error))
    throw InputError({a.out, 0, "FILE"}, "is where the frames are read from", "choose another name");
  refuse_existing(a.out, "FILE", a.force);
  Scene scene = read_run_scene(dir);
  const Topology topology = prepare(scene).topology;
  const auto frames = open_frames(from);
  const std::unique_ptr<Output> out = output_for(a.out, a.force);
  StoredFrame frame;
  long read = 0, written = 0;
  for (; frames->next(topology, frame); ++read) {
    if (frame.state.time < a.from_ps || (a.to_ps && frame.state.time > *a.to_ps) || read % a.every != 0) continue;
    out->add(topology, frame);
    ++written;
  }
  if (written == 0)
    throw InputError({from, 0, ""}, fmt::format("none of its {} frames was asked for", read),
                     "look at --from-ps, --to-ps and --every");
  out->end();
  fmt::print("{} written, {} frame{}\n", a.out, written, written == 1 ? "" : "s");
  return 0;
}

}  // namespace

void add_convert(CLI::App& app, Program& program) {
  const auto a = std::make_shared<ConvertArguments>();
  CLI::App* c = app.add_subcommand("convert", "Frames of a run in another format: GSD, LAMMPS dump, ParaView");
  c->add_option("dir", a->dir, "Directory of the run")->required();
  c->add_option("file", a->out,
                "File to write: .gsd (OVITO, MDAnalysis), .lammpstrj (LAMMPS, ASE) or .pvd (ParaView)")
      ->required();
  c->add_option("--from-ps", a->from_ps, "Leave out what is earlier")->capture_default_str();
  c->add_option("--to-ps", a->to_ps, "Leave out what is later");
  c->add_option("--every", a->every, "Every Nth frame")->check(whole_number(1))->capture_default_str();
  c->add_flag("--force", a->force, "Replace an existing file");
  c->callback([a, &program] { program.code = convert_command(*a); });
}

}  // namespace ropewalk
