// A LAMMPS with the part of the PLUGIN package that ours needs: opens the plugin and registers its styles.
// Debian's LAMMPS lacks that package. First argument: the plugin; then those of LAMMPS. Each rank says at the end how
// many bytes it has sent, and got by messages to all, in how many messages, and how many bytes it holds.
#include <dlfcn.h>
#include <malloc.h>
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

long long bytes = 0, messages = 0;

void count(long long numbers, MPI_Datatype type) {
  int size = 0;
  PMPI_Type_size(type, &size);
  bytes += numbers * size;
  ++messages;
}
int ranks() {
  int all = 0;
  PMPI_Comm_size(MPI_COMM_WORLD, &all);
  return all;
}

}  // namespace

// LAMMPS and the plugin find these before those of the library of MPI.
extern "C" {
int MPI_Send(const void* from, int n, MPI_Datatype t, int to, int tag, MPI_Comm c) {
  count(n, t);
  return PMPI_Send(from, n, t, to, tag, c);
}
int MPI_Rsend(const void* from, int n, MPI_Datatype t, int to, int tag, MPI_Comm c) {
  count(n, t);
  return PMPI_Rsend(from, n, t, to, tag, c);
}
int MPI_Isend(const void* from, int n, MPI_Datatype t, int to, int tag, MPI_Comm c, MPI_Request* r) {
  count(n, t);
  return PMPI_Isend(from, n, t, to, tag, c, r);
}
int MPI_Sendrecv(const void* from, int n, MPI_Datatype t, int to, int tag, void* into, int m, MPI_Datatype u, int source,
                 int other, MPI_Comm c, MPI_Status* s) {
  count(n, t);
  return PMPI_Sendrecv(from, n, t, to, tag, into, m, u, source, other, c, s);
}
int MPI_Allreduce(const void* from, void* into, int n, MPI_Datatype t, MPI_Op op, MPI_Comm c) {
  count(n, t);
  return PMPI_Allreduce(from, into, n, t, op, c);
}
int MPI_Allgather(const void* from, int n, MPI_Datatype t, void* into, int m, MPI_Datatype u, MPI_Comm c) {
  count(static_cast<long long>(m) * ranks(), u);
  return PMPI_Allgather(from, n, t, into, m, u, c);
}
int MPI_Allgatherv(const void* from, int n, MPI_Datatype t, void* into, const int* m, const int* at, MPI_Datatype u,
                   MPI_Comm c) {
  long long all = 0;
  for (int k = 0; k < ranks(); ++k) all += m[k];
  count(all, u);
  return PMPI_Allgatherv(from, n, t, into, m, at, u, c);
}
int MPI_Alltoallv(const void* from, const int* n, const int* from_at, MPI_Datatype t, void* into, const int* m,
                  const int* at, MPI_Datatype u, MPI_Comm c) {
  long long all = 0;
  for (int k = 0; k < ranks(); ++k) all += n[k];
  count(all, t);
  return PMPI_Alltoallv(from, n, from_at, t, into, m, at, u, c);
}
int MPI_Bcast(void* of, int n, MPI_Datatype t, int root, MPI_Comm c) {
  count(n, t);
  return PMPI_Bcast(of, n, t, root, c);
}
}

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
  const struct mallinfo2 heap = mallinfo2();
  lammps_close(lmp);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  std::printf("rank %d: %lld bytes, %lld messages, %lld bytes held\n", rank, bytes, messages,
              static_cast<long long>(heap.uordblks + heap.hblkhd));
  std::fflush(stdout);
  MPI_Finalize();
  return 0;
}
