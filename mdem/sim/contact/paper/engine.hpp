// Contact by the paper law: runs of neighbours and buffers around the kernel (contact_paper_kernel.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "sim/contact/shared/neighbour_spans.hpp"
#include "sim/contact/shared/damping.hpp"

namespace ropewalk {

// Places and axes of all elements as the kernel reads them: in nm, or in 32-bit integers, so that differences in
// single precision are exact. Runs are read in whole vectors, hence the room behind.
template <class T>
struct PaperElements {
  using Coordinate = std::conditional_t<sizeof(T) == 4, std::int32_t, double>;
  static constexpr std::size_t pad = 16;
  std::vector<Coordinate> x, y, z;
  std::vector<T> nx, ny, nz;
  double unit = 1;  // nm

  void resize(std::size_t n) {
    for (auto* v : {&x, &y, &z}) v->resize(n + pad);
    for (auto* v : {&nx, &ny, &nz}) v->resize(n + pad);
  }
  void place(const Vec3Array& position, const Vec3Array& axis, std::size_t begin, std::size_t end);
};

template <class T>
struct PaperKernelInput {
  const PaperContact* law;
  const PaperElements<T>* elements;
  const Vec3Array* axis;
  const PairRuns* runs;
  bool legacy_torque;
  bool energies;  // whether they are summed
};

// One chunk with the widest vectors that the machine has.
void paper_contact(const PaperKernelInput<float>& in, const NeighbourList::Chunk& chunk,
                   ContactBuffer<double>& out);
void paper_contact(const PaperKernelInput<double>& in, const NeighbourList::Chunk& chunk,
                   ContactBuffer<double>& out);

class PaperEngine {
 public:
  // Fills buffers[chunk].
  void compute(const Topology& topology, const Interaction& interaction, const NeighbourList& list,
               const State& state, const Vec3Array& axis, ContactBuffer<double>* buffers, bool energies = true);
  const PairRuns& runs() const { return runs_; }
  double list_seconds() const { return list_seconds_; }  // spent on the runs so far
  std::size_t bytes() const;

 private:
  template <class T>
  void run(PaperElements<T>& elements, const Interaction& interaction, const NeighbourList& list,
           const State& state, const Vec3Array& axis, ContactBuffer<double>* buffers, bool energies);

  void list_damped(const Topology& topology, const Interaction& interaction, const NeighbourList& list);

  PairRuns runs_;
  std::vector<std::vector<DampedBlock>> damped_;  // of each chunk
  PaperElements<float> mixed_;
  PaperElements<double> full_;
  long stamp_ = 0;
  double list_seconds_ = 0;
};

}  // namespace ropewalk
