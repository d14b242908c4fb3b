#include "sim/forces/force_terms.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "model/contract.hpp"
#include "sim/forces/forces.hpp"
#include "sim/forces/terms/damping_terms.hpp"

namespace ropewalk {
namespace {

constexpr std::size_t head = 3, numbers_of_event = 6;  // numbers of a record's head; of an event before its word

void add_sum(TermSum& all, const TermSum& one) {
  all.energy += one.energy;
  all.power += one.power;
}

bool earlier(const TermEvent& x, const TermEvent& y) { return std::pair(x.time, x.a) < std::pair(y.time, y.a); }

[[noreturn]] void refuse_memory() { throw std::runtime_error("the memory of the force terms is damaged"); }

// A whole number from 0, below `end`.
std::size_t whole(double number, double end) {
  if (!(number >= 0 && number < end) || number != std::floor(number)) refuse_memory();
  return static_cast<std::size_t>(number);
}

bool same_terms(const Damping& a, const Damping& b) {
  return a.local == b.local && a.contact.eta == b.contact.eta && a.contact.inner == b.contact.inner &&
         a.contact.outer == b.contact.outer;
}

}  // namespace

std::vector<double> numbers_of(const TermStates& memories) {
  std::vector<double> numbers;
  const auto add = [&](std::size_t term, int element, const std::vector<double>& of) {
    numbers.insert(numbers.end(),
                   {static_cast<double>(term), static_cast<double>(element), static_cast<double>(of.size())});
    numbers.insert(numbers.end(), of.begin(), of.end());
  };
  for (std::size_t term = 0; term < memories.records.size(); ++term) {
    const TermAccount& a = memories.accounts[term];
    if (a.lost != 0 || a.drag != 0 || a.events != 0 || a.begun != 0)
      add(term, the_account, {a.lost, a.drag, a.events, a.begun});
    for (const TermRecord& r : memories.records[term]) add(term, r.element, r.numbers);
  }
  return numbers;
}

std::size_t record_length(const std::vector<double>& numbers, std::size_t at) {
  if (at + head > numbers.size()) return 0;
  const double count = numbers[at + 2];
  if (!(count >= 0 && count <= static_cast<double>(numbers.size() - at - head)) || count != std::floor(count)) return 0;
  return head + static_cast<std::size_t>(count);
}

std::vector<double> numbers_of(const std::vector<TermEvent>& events) {
  std::vector<double> numbers;
  for (const TermEvent& e : events) {
    numbers.insert(numbers.end(), {0, an_event, static_cast<double>(numbers_of_event + e.what.size()), e.time,
                                   static_cast<double>(e.a), static_cast<double>(e.b), e.place.x(), e.place.y(),
                                   e.place.z()});
    numbers.insert(numbers.end(), e.what.begin(), e.what.end());
  }
  return numbers;
}

std::vector<TermEvent> take_events(std::vector<double>& numbers, int elements) {
  constexpr std::size_t longest_word = 40;
  std::vector<TermEvent> events;
  std::size_t kept = 0;
  for (std::size_t at = 0, length; at < numbers.size(); at += length) {
    length = record_length(numbers, at);
    if (length == 0) refuse_memory();
    const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(at),
               end = begin + static_cast<std::ptrdiff_t>(length);
    if (begin[1] != an_event) {
      std::copy(begin, end, numbers.begin() + static_cast<std::ptrdiff_t>(kept));
      kept += length;
      continue;
    }
    const auto word = begin + static_cast<std::ptrdiff_t>(head + numbers_of_event);
    if (length < head + numbers_of_event || length > head + numbers_of_event + longest_word ||
        !std::all_of(begin, end, [](double x) { return std::isfinite(x); }) ||
        !std::all_of(word, end, [](double x) { return x == ' ' || (x >= 'a' && x <= 'z'); }))
      refuse_memory();
    TermEvent e{begin[3], "", static_cast<int>(whole(begin[4], elements)), static_cast<int>(whole(begin[5], elements)),
                Vector3(begin[6], begin[7], begin[8])};
    std::transform(word, end, std::back_inserter(e.what), [](double x) { return static_cast<char>(x); });
    events.push_back(std::move(e));
  }
  numbers.resize(kept);
  std::stable_sort(events.begin(), events.end(), earlier);
  return events;
}

TermStates memories_of(const std::vector<double>& numbers, std::size_t terms, int elements) {
  TermStates all{std::vector<TermState>(terms), std::vector<TermAccount>(terms)};
  for (std::size_t at = 0, length; at < numbers.size(); at += length) {
    length = record_length(numbers, at);
    if (length == 0) refuse_memory();
    const std::size_t term = whole(numbers[at], static_cast<double>(terms));
    const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(at + head),
               end = numbers.begin() + static_cast<std::ptrdiff_t>(at + length);
    if (numbers[at + 1] == the_account) {
      const bool could_be = end - begin == 4 && std::isfinite(begin[0]) && std::isfinite(begin[1]) && begin[2] >= 0 &&
                            std::isfinite(begin[2]) && begin[3] >= 0 && std::isfinite(begin[3]);
      if (!could_be) refuse_memory();
      all.accounts[term].add({begin[0], begin[1], begin[2], begin[3]});
    } else {
      all.records[term].push_back({static_cast<int>(whole(numbers[at + 1], elements)), {begin, end}});
    }
  }
  for (TermState& records : all.records)
    std::stable_sort(records.begin(), records.end(),
                     [](const TermRecord& a, const TermRecord& b) { return a.element < b.element; });
  return all;
}

bool ForceTerms::use(const Interaction& in) {
  if (copied_ == in.terms && same_terms(damping_, in.damping)) return false;
  copied_ = in.terms;
  damping_ = in.damping;
  terms_.clear();
  for (const auto& term : in.terms)
    terms_.push_back({term->copy(), {}, {}, {0, 0, 0, static_cast<double>(term->begun_at_start())}});
  if (damping_.contact.eta > 0) terms_.push_back({contact_viscosity_term(damping_.contact), {}, {}});
  if (damping_.local > 0) terms_.push_back({local_damping_term(damping_.local), {}, {}});
  in_kick_ = std::any_of(terms_.begin(), terms_.end(), [](const Working& w) { return w.term->acts_in_kick(); });
  stamp_ = 0;
  return true;
}

void ForceTerms::prepare(const Topology& topology, const NeighbourList& list, const State& state, bool again) {
  if (stamp_ == list.stamp()) return;
  stamp_ = list.stamp();
  for (Working& w : terms_) w.term->prepare({topology, list, state, again, others_});
}

void ForceTerms::begin(const State& state, int parts) {
  ROPEWALK_EXPECTS(parts >= 0);
  state_ = &state;
  for (Working& w : terms_) {
    w.term->gather(state);
    w.of_part.assign(static_cast<std::size_t>(parts), {});
    w.of_chunk.assign(w.of_chunk.size(), {});
  }
}

double ForceTerms::advance(double dt, const State& state) {
  double lost = 0;
  for (Working& w : terms_) {
    const StateUpdate now = w.term->advance(dt, state);
    w.account.add({now.lost, 0, static_cast<double>(now.events), static_cast<double>(now.begun)});
    lost += now.lost;
    news_ = news_ || now.news;
  }
  return lost;
}

void ForceTerms::add(int part, const Segment& of, const ForceRows& out) {
  ROPEWALK_EXPECTS(of.begin < of.end);
  for (Working& w : terms_)
    if (!w.term->acts_in_kick()) w.of_part[static_cast<std::size_t>(part)] = w.term->add(*state_, of, out);
}

// Parts and chunks in their order, whatever the threads.
void ForceTerms::sum_up(Forces& out, double passed) {
  out.term_energy.assign(copied_.size(), 0);
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    TermSum all;
    for (const TermSum& sum : terms_[k].of_part) add_sum(all, sum);
    for (const TermSum& sum : terms_[k].of_chunk) add_sum(all, sum);
    out.energy.terms += all.energy;
    out.damping_power += all.power;
    if (k >= copied_.size()) continue;
    out.term_energy[k] = all.energy;
    terms_[k].account.drag -= passed * all.power;
  }
}

double ForceTerms::reach() const {
  double farthest = 0;
  for (const Working& w : terms_) farthest = std::max(farthest, w.term->pair_reach());
  return farthest;
}

void ForceTerms::start(std::size_t chunks) {
  for (Working& w : terms_) {
    if (!(w.term->pair_reach() > 0)) continue;
    w.term->start_chunks(chunks);
    w.of_chunk.assign(chunks, {});
  }
}

void ForceTerms::list(std::size_t chunk, const ChunkPairs& pairs) {
  for (Working& w : terms_)
    if (w.term->pair_reach() > 0) w.term->list_chunk(chunk, pairs);
}

void ForceTerms::add(std::size_t chunk, const PairBuffer& buffer) {
  for (Working& w : terms_)
    if (w.term->pair_reach() > 0) w.of_chunk[chunk] = w.term->add_pairs(*state_, chunk, buffer);
}

void ForceTerms::add_in_kick(const State& state, const ForceRows& total, const Segment& of,
                             const ForceRows& out) const {
  for (const Working& w : terms_)
    if (w.term->acts_in_kick()) w.term->add_in_kick(state, total, of, out);
}

std::string ForceTerms::add_tangent(const State& state, const ForceTerm::AddBlock& add) const {
  for (std::size_t k = 0; k < copied_.size(); ++k)
    if (!terms_[k].term->add_tangent(state, add)) return terms_[k].term->name();
  return "";
}

std::vector<TermAccount> ForceTerms::accounts() const {
  std::vector<TermAccount> all;
  for (std::size_t k = 0; k < copied_.size(); ++k) all.push_back(terms_[k].account);
  return all;
}

const std::vector<char>* ForceTerms::broken_bonds() const {
  for (const Working& w : terms_)
    if (const std::vector<char>* broken = w.term->broken_bonds()) return broken;
  return nullptr;
}

std::vector<TermEvent> ForceTerms::events() const {
  std::vector<TermEvent> all = earlier_;
  for (const Working& w : terms_) {
    const std::vector<TermEvent> of_term = w.term->events();
    all.insert(all.end(), of_term.begin(), of_term.end());
  }
  std::stable_sort(all.begin(), all.end(), earlier);
  return all;
}

void ForceTerms::forget_events() {
  earlier_.clear();
  for (Working& w : terms_) w.term->forget_events();
}

std::vector<double> ForceTerms::memory() const {
  TermStates all;
  for (const Working& w : terms_) {
    all.records.push_back(w.term->memory());
    all.accounts.push_back(w.account);
  }
  return numbers_of(all);
}

std::vector<NamedMemory> ForceTerms::memories() const {
  std::vector<NamedMemory> all;
  for (std::size_t k = 0; k < copied_.size(); ++k)
    all.push_back({terms_[k].term->name(), terms_[k].term->memory()});
  return all;
}

void ForceTerms::set_memory(const std::vector<double>& numbers, int elements, bool goes_on) {
  const TermStates all = memories_of(numbers, terms_.size(), elements);
  earlier_ = goes_on ? events() : std::vector<TermEvent>();
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    terms_[k].term->forget_events();
    terms_[k].term->set_memory(all.records[k]);
    if (!goes_on) terms_[k].account = all.accounts[k];
  }
  stamp_ = 0;
  news_ = false;
}

std::vector<double> ForceTerms::halved_memory(const std::vector<int>& heirs) const {
  TermStates all;
  for (const Working& w : terms_) {
    all.records.push_back(w.term->halved(w.term->memory(), heirs));
    all.accounts.push_back(w.account);
  }
  return numbers_of(all);
}

std::size_t ForceTerms::bytes() const {
  std::size_t total = 0;
  for (const Working& w : terms_) total += w.term->bytes();
  return total;
}

}  // namespace ropewalk
