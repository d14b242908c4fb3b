#include "sim/step_bytes.hpp"

namespace ropewalk {
namespace {

template <class T>
double bytes_of(const std::vector<T>& v) {
  return static_cast<double>(v.size() * sizeof(T));
}

// Of a contact buffer: force and torque, written by the contact and read where they are collected.
double buffer_bytes(double elements, std::size_t number) { return 2 * 6 * static_cast<double>(number) * elements; }

double line_bytes(const LineList& list, std::size_t number) {
  double sum = 0;
  for (const LineChunk& chunk : list.chunks()) {
    sum += bytes_of(chunk.parts) + bytes_of(chunk.blocks) + bytes_of(chunk.runs) + bytes_of(chunk.end_runs) +
           bytes_of(chunk.damped) + bytes_of(chunk.damped_parts) + buffer_bytes(chunk.elements, number);
    for (const AlikePairs& of : chunk.end_pairs) sum += bytes_of(of.pairs);
  }
  return sum;
}

double paper_bytes(const NeighbourList& list, const PairRuns& runs) {
  double sum = static_cast<double>(runs.count() * sizeof(PairRun));
  for (const NeighbourList::Chunk& chunk : list.chunks())
    sum += buffer_bytes(chunk.touched_end - chunk.touched_begin, sizeof(double));
  return sum;
}

}  // namespace

double step_bytes(const Simulation& simulation) {
  constexpr int state = 3 + 4 + 3 + 3, axis = 3;  // numbers of an element
  const Interaction& in = simulation.interaction();
  const auto elements = static_cast<double>(simulation.state().size());
  double sum = 2 * state * sizeof(double) * elements;
  if (!in.has_contact()) return sum;
  sum += 2 * axis * sizeof(double) * elements;
  const ForceEngine& engine = simulation.engine();
  if (in.paper) return sum + paper_bytes(simulation.list(), engine.paper().runs());
  return sum + line_bytes(engine.line().list(),
                          in.precision == Interaction::Precision::mixed ? sizeof(float) : sizeof(double));
}

}  // namespace ropewalk
