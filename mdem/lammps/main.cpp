// lmp-ropewalk: LAMMPS with our styles. Takes LAMMPS's own command line.
#include <dlfcn.h>
#include <mpi.h>

#include <cstdio>
#include <memory>
#include <string>

#include "input.h"
#include "lammps.h"
#include "lammps/model.hpp"
#include "lammps/register.hpp"
#include "library.h"

namespace {

bool hooked = false;

}  // namespace

// Styles live in objects that the command `clear` throws away and makes anew; the last thing that LAMMPS then does
// is this call. Standing in the program it goes before the library's own, which does the rest.
void LAMMPS_NS::LAMMPS::post_create() {
  using Call = void (*)(LAMMPS*);
  static const auto original = reinterpret_cast<Call>(dlsym(RTLD_NEXT, "_ZN9LAMMPS_NS6LAMMPS11post_createEv"));
  if (original) original(this);
  ropewalk::lammps::register_styles(this);
  hooked = original != nullptr;
}

namespace {

int complain(int rank, const std::string& what) {
  if (rank == 0) std::fprintf(stderr, "lmp-ropewalk: %s\n", what.c_str());
  MPI_Finalize();
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  {
    // lammps_version does not look into the object: with another library its inside is another.
    const std::string complaint = ropewalk::version_complaint(ROPEWALK_LAMMPS_VERSION, lammps_version(nullptr));
    if (!complaint.empty()) return complain(rank, complaint);
  }
  {
    const auto lmp = std::make_unique<LAMMPS_NS::LAMMPS>(argc, argv, MPI_COMM_WORLD);
    if (!hooked) {
      return complain(rank,
                      "this LAMMPS library does not let its styles be kept over `clear`; use the plugin, or link a "
                      "shared library made without -Bsymbolic");
    }
    lmp->input->file();
  }
  MPI_Finalize();  // after LAMMPS is gone, whose end still sends messages
  return 0;
}
