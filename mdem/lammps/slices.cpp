#include "lammps/slices.hpp"

#include <numeric>

#include "sim/forces/force_terms.hpp"

namespace ropewalk::lammps {

std::vector<double> Slices::exchange(const std::vector<std::vector<double>>& to) const {
  std::vector<int> send, receive(to.size()), send_at(to.size()), receive_at(to.size());
  std::vector<double> all;
  for (const std::vector<double>& list : to) {
    send.push_back(static_cast<int>(list.size()));
    all.insert(all.end(), list.begin(), list.end());
  }
  MPI_Alltoall(send.data(), 1, MPI_INT, receive.data(), 1, MPI_INT, lmp_->world);
  std::partial_sum(send.begin(), send.end() - 1, send_at.begin() + 1);
  std::partial_sum(receive.begin(), receive.end() - 1, receive_at.begin() + 1);
  std::vector<double> out(static_cast<std::size_t>(receive.back() + receive_at.back()));
  MPI_Alltoallv(all.data(), send.data(), send_at.data(), MPI_DOUBLE, out.data(), receive.data(), receive_at.data(),
                MPI_DOUBLE, lmp_->world);
  return out;
}

std::vector<double> Slices::bring(const std::vector<double>& records,
                                  const std::function<int(int)>& rank_of) const {
  std::vector<std::vector<double>> to(static_cast<std::size_t>(lmp_->comm->nprocs));
  for_records(records, [&](int element, const double* of, std::size_t count) {
    const int rank = rank_of(element);
    if (rank < 0) return;
    std::vector<double>& list = to[static_cast<std::size_t>(rank)];
    list.insert(list.end(), of, of + count);
  });
  return exchange(to);
}

std::vector<double> Slices::bring_to_owners(const std::vector<double>& records, const std::vector<int>& own) const {
  const int me = lmp_->comm->me;
  std::vector<double> mine;
  for (const int element : own)
    mine.insert(mine.end(), {0, static_cast<double>(element), 1, static_cast<double>(me)});
  const LMP::bigint first = begin(me);
  std::vector<int> owner(static_cast<std::size_t>(begin(me + 1) - first), -1);
  for_records(bring(mine, [this](int element) { return of(element); }),
              [&](int element, const double* record, std::size_t) {
                owner[static_cast<std::size_t>(element - first)] = static_cast<int>(record[3]);
              });
  return bring(bring(records, [this](int element) { return of(element); }),
               [&](int element) { return owner[static_cast<std::size_t>(element - first)]; });
}

}  // namespace ropewalk::lammps
