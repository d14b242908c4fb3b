// lmp-ropewalk: LAMMPS with our styles. Takes LAMMPS's own command line.
#include <dlfcn.h>
#include <mpi.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "input.h"
#include "io/program.hpp"
#include "lammps.h"
#include "lammps/model.hpp"
#include "lammps/register.hpp"
#define LAMMPS_LIB_MPI  // declares lammps_open
#include "library.h"

namespace {

bool hooked = false;

[[noreturn]] void complain(const std::string& what) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0) std::fprintf(stderr, "lmp-ropewalk: %s\n", what.c_str());
  MPI_Finalize();
  std::exit(2);
}

}  // namespace

// LAMMPS keeps its styles in objects that the command `clear` deletes and makes again; its last call then is this
// function. The definition in the program takes precedence over the library's, which it calls for the rest.
void LAMMPS_NS::LAMMPS::post_create() {
  // Check the version before any access to the object, whose layout differs between versions.
  const std::string complaint = ropewalk::version_complaint(ROPEWALK_LAMMPS_VERSION, lammps_version(this));
  if (!complaint.empty()) complain(complaint);
  using Call = void (*)(LAMMPS*);
  static const auto original = reinterpret_cast<Call>(dlsym(RTLD_NEXT, "_ZN9LAMMPS_NS6LAMMPS11post_createEv"));
  if (original) original(this);
  ropewalk::lammps::register_styles(this);
  hooked = original != nullptr;
}

int main(int argc, char** argv) {
  ropewalk::begin_program("lmp-ropewalk");
  MPI_Init(&argc, &argv);
  void* lmp = lammps_open(argc, argv, MPI_COMM_WORLD, nullptr);
  if (!hooked)
    complain(
        "this LAMMPS library does not let our styles be kept over `clear`; use the plugin, or a shared library "
        "made without -Bsymbolic");
  static_cast<LAMMPS_NS::LAMMPS*>(lmp)->input->file();
  lammps_close(lmp);
  MPI_Finalize();  // after LAMMPS is closed, since closing sends messages
  return 0;
}
