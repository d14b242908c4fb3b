#include "bench/step_bytes.hpp"

namespace ropewalk {
namespace {

template <class T>
double bytes_of(const std::vector<T>& v) {
  return static_cast<double>(v.size() * sizeof(T));
}

// Of a contact buffer: force and torque, written by the contact and read where they are collected.
double buffer_bytes(double elements, std::size_t number) { return 2 * 6 * static_cast<double>(number) * elements; }

double line_bytes(const LineList& list, std::size_t number) {
  double sum = static_cast<double>(list.spans() * sizeof(NeighbourSpan));
  for (const LineChunk& chunk : list.chunks()) {
    sum += bytes_of(chunk.ranges) + bytes_of(chunk.damped) + bytes_of(chunk.damped_ranges) +
           buffer_bytes(chunk.elements, number);
  }
  return sum;
}

// The kernel has places and axes of its own.
double paper_bytes(const NeighbourList& list, const PairRuns& runs, std::size_t number) {
  const auto elements = static_cast<double>(list.reference().size());
  double sum = 2 * 6 * static_cast<double>(number) * elements + static_cast<double>(runs.bytes());
  for (const NeighbourList::Chunk& chunk : list.chunks())
    sum += buffer_bytes(chunk.touched_end - chunk.touched_begin, sizeof(double));
  return sum;
}

}  // namespace

double step_bytes(const Simulation& simulation) {
  constexpr int state = 3 + 4 + 3 + 3, axis = 3, force = 3 + 3;  // numbers of an element
  const Interaction& in = simulation.interaction();
  const auto elements = static_cast<double>(simulation.state().size());
  // On two levels each of the bonds' steps. There, and where the local damping waits for all forces, these are
  // stored.
  const int passes = simulation.stepping().contact_every;
  const bool stored = passes > 1 || in.damping.local > 0;
  double sum = 2.0 * passes * (state + (stored ? force : 0)) * sizeof(double) * elements;
  if (!in.has_contact()) return sum;
  sum += 2 * axis * sizeof(double) * elements;
  const std::size_t number = in.precision == Interaction::Precision::mixed ? sizeof(float) : sizeof(double);
  const ForceEngine& engine = simulation.engine();
  return sum + (in.paper ? paper_bytes(simulation.list(), engine.paper().runs(), number)
                         : line_bytes(engine.line().list(), number));
}

}  // namespace ropewalk
