// Contact by the paper law: spans of neighbours, positions and axes around the kernel (kernel.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "sim/contact/paper/law.hpp"
#include "sim/contact/shared/buffered_engine.hpp"
#include "sim/contact/shared/neighbour_spans.hpp"

namespace ropewalk {

// Positions and axes of all elements as the kernel reads them. In single precision positions are whole numbers of
// `unit` modulo 2^32 (sim/contact/shared/wrapped.hpp); in double precision they are in nm. The kernel loads whole
// vectors, hence the padding.
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
  const ElementSpans* spans;
  bool legacy_torque;
  bool energies;  // sum the energies
};

// Computes one chunk with the widest vectors of the machine.
void paper_contact(const PaperKernelInput<float>& in, const NeighbourList::Chunk& chunk,
                   ContactBuffer<double>& out);
void paper_contact(const PaperKernelInput<double>& in, const NeighbourList::Chunk& chunk,
                   ContactBuffer<double>& out);

class PaperEngine : public BufferedEngine {
 public:
  std::unique_ptr<ContactEngine> copy() const override { return std::make_unique<PaperEngine>(*this); }
  const ElementSpans& spans() const { return spans_; }
  std::size_t bytes() const override;
  double step_bytes(const NeighbourList& list, std::size_t number) const override;

 protected:
  void update_list(const ContactInput& in) override;
  void prepare(const ContactInput& in) override;
  void add_chunk(const ContactInput& in, const NeighbourList::Chunk& chunk, ContactBuffer<double>& out) override;

 private:
  ElementSpans spans_;
  PaperElements<float> mixed_;
  PaperElements<double> full_;
};

}  // namespace ropewalk
