// `cite`: what a paper that shows a run has to cite, as BibTeX.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "commands/verb.hpp"
#include "io/manifest.hpp"
#include "run/run_directory.hpp"

namespace ropewalk {
namespace {

// TeX's special characters. A text may quote anything.
std::string tex(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\' || c == '{' || c == '}' || c == '~' || c == '^') continue;
    if (std::string("&%$#_").find(c) != std::string::npos) out += '\\';
    out += c;
  }
  return out;
}

std::string key_of(const std::string& name) {
  std::string key;
  for (const char c : name) key += std::isalnum(static_cast<unsigned char>(c)) || c == '-' ? c : '-';
  return key;
}

// The references of CITATION.cff.
constexpr const char* model =
    "@article{mdem-twist,\n"
    "  title = {Twisting carbon nanotube ropes with the mesoscopic distinct element method: geometry, packing, and "
    "nanomechanics},\n"
    "  author = {Wang, Yuezhou and Ostanin, Igor and Gaidau, Cristian and Dumitrica, Traian},\n"
    "  journal = {Langmuir}, year = {2015}, doi = {10.1021/acs.langmuir.5b03208}\n}\n\n"
    "@article{mdem,\n"
    "  title = {A distinct element method for large scale simulations of carbon nanotube assemblies},\n"
    "  author = {Ostanin, Igor and Ballarini, Roberto and Potyondy, David and Dumitrica, Traian},\n"
    "  journal = {Journal of the Mechanics and Physics of Solids}, year = {2013}, doi = "
    "{10.1016/j.jmps.2012.10.016}\n}\n\n"
    "@article{elastic-bonds,\n"
    "  title = {Vector-based model of elastic bonds for simulation of granular solids},\n"
    "  author = {Kuzkin, Vitaly A. and Asonov, Igor E.},\n"
    "  journal = {Physical Review E}, year = {2012}, doi = {10.1103/PhysRevE.86.051301}\n}\n";

// The set, and what its reference names: for calibrated sets the potential.
void cite_set(const ParameterSet& set) {
  fmt::print("\n@misc{{{},\n  title = {{Parameter set {} of Ropewalk}}, note = {{xxh64 {}{}{}}}{}\n}}\n",
             key_of(set.name), tex(set.name), set.hash, set.reference.empty() ? "" : "; after ", tex(set.reference),
             set.doi.empty() ? "" : ", doi = {" + set.doi + "}");
}

int cite_command(const std::string& directory) {
  const RunDirectory dir{directory};
  refuse_strange_files(dir);
  const Scene scene = read_run_scene(dir);
  const Manifest m = read_manifest(dir.manifest());
  fmt::print(
      "@software{{ropewalk,\n  title = {{Ropewalk: calibration, validation and simulation of carbon-nanotube "
      "ropes}},\n"
      "  author = {{{{The Ropewalk authors}}}}, version = {{{}}}, note = {{{}; scene {}, xxh64 {}}}\n}}\n\n{}",
      m.version, tex(m.git_id), tex(scene.name), m.scene_hash, model);
  for (const ParameterSet& set : scene.sets) cite_set(set);
  for (const std::string& file : scene.files_of_drives()) {
    const std::string name = file.substr(file.rfind('/') + 1);
    const std::string stem = name.substr(0, name.rfind('.'));
    fmt::print("\n@misc{{{},\n  title = {{{} of Ropewalk, measured from atoms}}\n}}\n", key_of(stem), tex(stem));
  }
  return 0;
}

}  // namespace

void add_cite(CLI::App& app, Program& program) {
  const auto run = std::make_shared<std::string>();
  CLI::App* c = app.add_subcommand("cite", "Name what a paper that shows a run should cite, as BibTeX");
  c->add_option("dir", *run, "Directory of the run")->required();
  c->callback([run, &program] { program.code = cite_command(*run); });
}

}  // namespace ropewalk
