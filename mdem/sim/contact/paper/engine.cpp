#include "sim/contact/paper/engine.hpp"

#include <algorithm>
#include <cmath>

#include "sim/threads/for_each.hpp"

namespace ropewalk {

template <class T>
void PaperElements<T>::place(const Vec3Array& position, const Vec3Array& axis, std::size_t begin, std::size_t end) {
  const double per_unit = 1 / unit;
  const auto coordinate = [&](double v) {
    if constexpr (sizeof(T) == 4) return static_cast<Coordinate>(std::llrint(v * per_unit));
    return static_cast<Coordinate>(v);
  };
  for (std::size_t i = begin; i < end; ++i) {
    x[i] = coordinate(position.x[i]);
    y[i] = coordinate(position.y[i]);
    z[i] = coordinate(position.z[i]);
    nx[i] = static_cast<T>(axis.x[i]);
    ny[i] = static_cast<T>(axis.y[i]);
    nz[i] = static_cast<T>(axis.z[i]);
  }
}

namespace {

const PaperLaw& law_of(const ContactInput& in) { return static_cast<const PaperLaw&>(*in.interaction.law); }
bool full(const ContactInput& in) { return in.interaction.precision == Interaction::Precision::full; }

template <class T>
void place_all(const ContactInput& in, PaperElements<T>& elements) {
  const auto n = static_cast<std::ptrdiff_t>(in.state.size());
  constexpr std::ptrdiff_t block = 512;
  elements.resize(in.state.size());
  for_each((n + block - 1) / block, in.state.size() > parallel_from, [&](std::ptrdiff_t k) {
    elements.place(in.state.position, in.axis, static_cast<std::size_t>(k * block),
                   static_cast<std::size_t>(std::min((k + 1) * block, n)));
  });
}

}  // namespace

void PaperEngine::update_list(const ContactInput& in) {
  spans_.build(in.list, law_of(in).cutoff());
  mixed_.unit = in.list.coordinate_unit();
}

void PaperEngine::prepare(const ContactInput& in) {
  if (full(in)) {
    place_all(in, full_);
  } else {
    place_all(in, mixed_);
  }
}

// Always with energies: the compiler orders the sums of these loops as it likes, and forces must be the same bits
// whether energies are wanted or not.
void PaperEngine::add_chunk(const ContactInput& in, const NeighbourList::Chunk& chunk, ContactBuffer<double>& out) {
  const PaperLaw& law = law_of(in);
  if (full(in)) {
    paper_contact(PaperKernelInput<double>{&law.contact, &full_, &in.axis, &spans_, law.legacy_torque, true}, chunk,
                  out);
  } else {
    paper_contact(PaperKernelInput<float>{&law.contact, &mixed_, &in.axis, &spans_, law.legacy_torque, true}, chunk,
                  out);
  }
}

std::size_t PaperEngine::bytes() const {
  const auto of = [](const auto& e) {
    return 3 * (e.x.capacity() * sizeof(e.x[0]) + e.nx.capacity() * sizeof(e.nx[0]));
  };
  return BufferedEngine::bytes() + spans_.bytes() + of(mixed_) + of(full_);
}

// The kernel has positions and axes of its own.
double PaperEngine::step_bytes(const NeighbourList& list, std::size_t number) const {
  const auto elements = static_cast<double>(list.reference().size());
  return BufferedEngine::step_bytes(list, number) + buffer_bytes(elements, number) +
         static_cast<double>(spans_.bytes());
}

}  // namespace ropewalk
