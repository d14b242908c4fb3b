// A LAMMPS with the part of the PLUGIN package that ours needs: opens the plugin and registers its styles.
// Debian's LAMMPS lacks that package. First argument: the plugin; then those of LAMMPS.
#include <dlfcn.h>
#include <mpi.h>

#include <cstdio>
#include <string>

#include "force.h"
#include "input.h"
#include "lammps.h"
#include "modify.h"
#define LAMMPS_LIB_MPI
#include "library.h"

namespace {

using namespace LAMMPS_NS;

// As LAMMPS's documentation of plugins has it.
struct Announced {
  const char *version, *style, *name, *info, *author;
  void* creator;
  void* handle;
};

void announce(Announced* style, void* handle) {
  auto* lmp = static_cast<LAMMPS_NS::LAMMPS*>(handle);
  const std::string kind = style->style;
  std::printf("plugin: %s %s for LAMMPS %s\n", style->style, style->name, style->version);
  if (kind == "pair") (*lmp->force->pair_map)[style->name] = reinterpret_cast<Force::PairCreator>(style->creator);
  if (kind == "bond") (*lmp->force->bond_map)[style->name] = reinterpret_cast<Force::BondCreator>(style->creator);
  if (kind == "fix") (*lmp->modify->fix_map)[style->name] = reinterpret_cast<Modify::FixCreator>(style->creator);
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  void* plugin = argc > 1 ? dlopen(argv[1], RTLD_NOW | RTLD_GLOBAL) : nullptr;
  using Init = void (*)(void*, void*, void*);
  const auto init = plugin ? reinterpret_cast<Init>(dlsym(plugin, "lammpsplugin_init")) : nullptr;
  if (!init) {
    std::fprintf(stderr, "no plugin: %s\n", dlerror());
    return 2;
  }
  void* lmp = lammps_open(argc - 1, argv + 1, MPI_COMM_WORLD, nullptr);
  init(lmp, plugin, reinterpret_cast<void*>(&announce));
  static_cast<LAMMPS_NS::LAMMPS*>(lmp)->input->file();
  lammps_close(lmp);
  MPI_Finalize();
  return 0;
}
