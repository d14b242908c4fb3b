#include "scene/state_csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "io/csv_reader.hpp"
#include "io/files.hpp"
#include "io/plain_text.hpp"
#include "io/toml_table.hpp"  // printable
#include "model/error.hpp"
#include "scene/bounds.hpp"

namespace ropewalk {
namespace {

constexpr std::array<OutputColumn, 14> columns = {{
    {"tube", "", "tube, from 0; its elements follow one another along it"},
    {"x_nm", "nm", "centre of the element"},
    {"y_nm", "nm", "centre of the element"},
    {"z_nm", "nm", "centre of the element"},
    {"qw", "", "orientation, a quaternion that turns z into the axis of the tube: w"},
    {"qx", "", "orientation: x"},
    {"qy", "", "orientation: y"},
    {"qz", "", "orientation: z"},
    {"vx_nm_per_ps", "nm/ps", "velocity; a file may leave out these last six columns, all is then at rest"},
    {"vy_nm_per_ps", "nm/ps", "velocity"},
    {"vz_nm_per_ps", "nm/ps", "velocity"},
    {"wx_rad_per_ps", "rad/ps", "angular velocity, about the axes of space"},
    {"wy_rad_per_ps", "rad/ps", "angular velocity"},
    {"wz_rad_per_ps", "rad/ps", "angular velocity"},
}};
constexpr std::size_t columns_at_rest = 8;
const std::string whole_header = column_names(columns);
const std::string header = whole_header.substr(0, whole_header.find(",vx"));
constexpr double farthest = 1e7;                          // nm
constexpr double norm_slack = 1e-3;                       // allowed deviation of a quaternion's norm from 1
constexpr double norm_rounding = 1e-14;                   // deviation of its square up to which it stays as it is
constexpr double shortest_bond = 0.1, longest_bond = 10;  // element lengths
// Bounds of a tube's median bond over the element length. No strain that a tube bears reaches them, and elements of
// half or twice the length lie beyond them.
constexpr double shortest_usual = 0.75, longest_usual = 1.34;
// Bounds of a single bond over the element length. A line that is missing doubles one; a kink of 90 degrees makes
// it 0.7.
constexpr double shortest_single = 0.5, longest_single = 1.5;
constexpr const char* length_words = "element_length_nm: ";
constexpr const char* types_words = "tube_types: ";
constexpr const char* strands_words = "strands_begin_with_tubes: ";
constexpr const char* ropes_words = "ropes_begin_with_strands: ";
constexpr const char* memory_words = "memory: ";
constexpr const char* broken_words = "broken_behind_elements: ";
constexpr const char* written_words = "elements_and_sum: ";

struct Row {
  int tube = 0;
  Vector3 position;
  Quaternion orientation;
  Vector3 velocity, spin;
};

// The element length (nm) that a comment before the present line states; 0: none does.
double stated_length(const CsvReader& csv) {
  for (const std::string_view comment : csv.comments()) {
    if (comment.rfind(length_words, 0) != 0) continue;
    const std::string text(comment.substr(std::string_view(length_words).size()));
    std::size_t read = 0;
    const double length = leading_number(text, &read).value_or(0);
    if (read != text.size() || !(length > 0 && length <= farthest))
      csv.fail("", fmt::format("the comment above says \"{}\" of the element length", printable(text, 40)),
               "write a positive number of nm, or take the comment away");
    return length;
  }
  return 0;
}

// The number of parameter sets that a comment before the present line names by the types of the tubes; 0: none
// does.
int stated_sets(const CsvReader& csv) {
  for (const std::string_view comment : csv.comments()) {
    if (comment.rfind(types_words, 0) != 0) continue;
    const std::string text(comment.substr(std::string_view(types_words).size()));
    long most = -1;
    const char* at = text.c_str();
    for (char* end = nullptr;; at = end + 1) {
      const long type = std::strtol(at, &end, 10);
      if (end == at || type < 0 || type >= max_elements || (*end != ',' && *end != '\0'))
        csv.fail("", fmt::format("the comment above says \"{}\" of the types of tubes", printable(text, 40)),
                 "write numbers from 0 with commas between them, or take the comment away");
      most = std::max(most, type);
      if (*end == '\0') return static_cast<int>(most) + 1;
    }
  }
  return 0;
}

// A sum over all numbers of a state, by which a file shows that it is as it was written: 84 elements, 16 hex
// digits.
class StateSum {
 public:
  void add(int tube, const std::array<double, 13>& numbers) {
    ++elements_;
    hash_.append(reinterpret_cast<const char*>(&tube), sizeof tube);
    for (const double number : numbers) {
      const double same = number + 0.0;  // -0 is 0
      hash_.append(reinterpret_cast<const char*>(&same), sizeof same);
    }
    hash_ = hash_hex(hash_);
  }
  long elements() const { return elements_; }
  std::string words() const { return fmt::format("{}, {}", elements_, hash_); }

 private:
  long elements_ = 0;
  std::string hash_;  // hash of the one before and this element
};

std::string stated_sum(const CsvReader& csv) {
  for (const std::string_view comment : csv.comments())
    if (comment.rfind(written_words, 0) == 0)
      return std::string(comment.substr(std::string_view(written_words).size()));
  return "";
}

// The numbers that a comment before the present line lists behind `words`, rising from 0; none: no comment does.
std::vector<int> stated_begins(const CsvReader& csv, const char* words, const char* what, const char* each) {
  std::vector<int> first;
  for (const std::string_view comment : csv.comments()) {
    if (comment.rfind(words, 0) != 0) continue;
    const std::string text(comment.substr(std::string_view(words).size()));
    const char* at = text.c_str();
    for (char* end = nullptr;; at = end + 1) {
      const long begin = std::strtol(at, &end, 10);
      if (end == at || begin != (first.empty() ? 0 : std::max<long>(begin, first.back() + 1L)) ||
          begin >= max_elements || (*end != ',' && *end != '\0'))
        csv.fail(
            "", fmt::format("the comment above says \"{}\" of the {}", printable(text, 40), what),
            fmt::format("write the first {}, rising from 0, with commas between them, or take the comment away",
                        each));
      first.push_back(static_cast<int>(begin));
      if (*end == '\0') return first;
    }
  }
  return first;
}

std::vector<int> stated_strands(const CsvReader& csv) {
  return stated_begins(csv, strands_words, "strands", "tube of each strand");
}

// Elements, rising.
std::vector<int> stated_breaks(const CsvReader& csv) {
  std::vector<int> broken;
  for (const std::string_view comment : csv.comments()) {
    if (comment.rfind(broken_words, 0) != 0) continue;
    const std::string text(comment.substr(std::string_view(broken_words).size()));
    const char* at = text.c_str();
    for (char* end = nullptr;; at = end + 1) {
      const long element = std::strtol(at, &end, 10);
      if (end == at || element < 0 || element >= max_elements || (!broken.empty() && element <= broken.back()) ||
          (*end != ',' && *end != '\0'))
        csv.fail("", fmt::format("the comment above says \"{}\" of broken tubes", printable(text, 40)),
                 "write elements from 0, rising, with commas between them, or take the comment away");
      broken.push_back(static_cast<int>(element));
      if (*end == '\0') return broken;
    }
  }
  return broken;
}

class StateReader {
 public:
  StateReader(const std::string& path, Topology& topology) : path_(path), csv_(path), topology_(topology) {}

  State read() {
    if (!csv_.next()) fail("", "is empty", fmt::format("the first line must be {}", header));
    check_header();
    while (csv_.next()) {
      if (rows_.empty()) {
        check_length();
        check_sets();
        stated_sum_ = stated_sum(csv_);
        topology_.groups.strand_begin = stated_strands(csv_);
        broken_ = stated_breaks(csv_);
        topology_.groups.rope_begin = stated_begins(csv_, ropes_words, "ropes", "strand of each rope");
      }
      if (rows_.size() == static_cast<std::size_t>(max_elements))
        fail("", fmt::format("has more than {} elements", max_elements), "take fewer");
      const Row row = parsed();
      append_to_tubes(row);
      rows_.push_back(row);
    }
    if (rows_.empty()) fail("", "has no elements", "write one line for each, below the header");
    check_sum();
    if (!stated_) check_spacing();
    if (stated_sum_.empty() && far_bond_) throw InputError(*far_bond_);
    check_breaks();
    close_strands();
    close_ropes();
    return state();
  }

 private:
  [[noreturn]] void fail(const std::string& column, const std::string& what, const std::string& remedy) const {
    csv_.fail(column, what, remedy);
  }

  void check_header() {
    columns_here_ = csv_.cells().size();
    bool right = columns_here_ == columns_at_rest || columns_here_ == columns.size();
    for (std::size_t k = 0; right && k < columns_here_; ++k) right = csv_.cells()[k] == columns[k].name;
    if (!right)
      // Without its words: a scene of a stranger may name any file.
      fail("", "its first line is not the header of a state",
           fmt::format("it must be {0}, or {1}", header, whole_header));
  }

  // Elements and numbers are those that were written. Lines that are missing at the end of a tube, or numbers of
  // another unit, would else be a state as good as any.
  void check_sum() const {
    if (stated_sum_.empty() || stated_sum_ == sum_.words()) return;
    const std::string elements = stated_sum_.substr(0, stated_sum_.find(','));
    if (far_bond_) throw InputError(*far_bond_);
    throw InputError(
        {path_, 0, ""},
        elements == std::to_string(sum_.elements())
            ? "its numbers are not those that were written"
            : fmt::format("has {} elements, and {} were written", sum_.elements(), printable(elements, 20)),
        fmt::format(
            "bring it back from a copy; if you changed it yourself, take the line \"# {}...\" out of its header",
            written_words));
  }

  void check_breaks() const {
    if (joined_.size() == broken_.size()) return;
    for (const int e : broken_)
      if (static_cast<std::size_t>(e) + 1 >= rows_.size() ||
          rows_[static_cast<std::size_t>(e)].tube == rows_[static_cast<std::size_t>(e) + 1].tube)
        throw InputError({path_, 0, ""},
                         fmt::format("its comment has a tube that is broken behind element {}, where none ends", e),
                         "take the comment away, or complete the file");
  }

  void close_strands() {
    std::vector<int>& begin = topology_.groups.strand_begin;
    if (begin.empty()) return;
    // The comment counts the parts of broken tubes.
    for (int& tube : begin)
      tube -= static_cast<int>(std::upper_bound(joined_.begin(), joined_.end(), tube) - joined_.begin());
    if (begin.back() >= topology_.tubes())
      throw InputError({path_, 0, ""},
                       fmt::format("its comment has a strand that begins with tube {}, and there are {} tubes",
                                   begin.back(), topology_.tubes()),
                       "take the comment away, or complete the file");
    begin.push_back(topology_.tubes());
    if (!joined_.empty() && topology_.strands() == topology_.tubes()) {
      begin.clear();
      return;
    }
    // Along the chord of both elements at a hole.
    double holes = 0;
    for (int t = 0; t < topology_.tubes(); ++t) {
      if (topology_.begins_strand(t)) {
        holes = 0;
        continue;
      }
      const auto i = static_cast<std::size_t>(topology_.tube_begin[static_cast<std::size_t>(t)]);
      holes += (rows_[i].position - rows_[i - 1].position).norm() - element_length_;
      topology_.groups.strand_holes = std::max(topology_.groups.strand_holes, holes);
    }
  }

  void close_ropes() {
    std::vector<int>& begin = topology_.groups.rope_begin;
    if (begin.empty()) return;
    if (begin.back() >= topology_.strands())
      throw InputError({path_, 0, ""},
                       fmt::format("its comment has a rope that begins with strand {}, and there are {} strands",
                                   begin.back(), topology_.strands()),
                       "take the comment away, or complete the file");
    begin.push_back(topology_.strands());
  }

  // Compares the element length that the file states with the one that its elements are read with.
  void check_length() {
    const double length = stated_length(csv_);
    stated_ = length > 0;
    if (length > 0 && std::fabs(length / element_length_ - 1) > 1e-6)
      fail("",
           fmt::format("elements of this file are {:.6g} nm long, and are read as {:.6g} nm", length,
                       element_length_),
           fmt::format("take element_length_nm = {}, the length in the comment above", length));
  }

  // The energy of two kinds of tubes by the set of one is that of overlaps.
  void check_sets() const {
    const auto here = static_cast<int>(topology_.types.size());
    if (const int sets = stated_sets(csv_); sets > here)
      fail("",
           fmt::format("tubes of this file are of {} parameter sets, and {} given", sets,
                       here == 1 ? "1 is" : fmt::format("{} are", here)),
           "give all of them, in the order of the comment above: parameters and tube_types of a scene, "
           "--parameters and "
           "--tube-types of `ropewalk energy`");
  }

  // Checks the spacing in a file that does not state its element length.
  void check_spacing() const {
    std::size_t first = 0;
    for (int t = 0; t < topology_.tubes(); ++t, first = static_cast<std::size_t>(topology_.tube_begin[t])) {
      std::vector<double> bonds;
      for (std::size_t i = first + 1; i < static_cast<std::size_t>(topology_.tube_begin[t + 1]); ++i)
        bonds.push_back((rows_[i].position - rows_[i - 1].position).norm());
      if (bonds.empty()) continue;
      std::nth_element(bonds.begin(), bonds.begin() + static_cast<std::ptrdiff_t>(bonds.size() / 2), bonds.end());
      const double usual = bonds[bonds.size() / 2];
      if (usual < shortest_usual * element_length_ || usual > longest_usual * element_length_)
        throw InputError(
            {path_, 0, ""},
            fmt::format("elements of tube {} follow one another at {:.4g} nm, and are read as {:.4g} nm "
                        "long",
                        t, usual, element_length_),
            "give the length that they had: element_length_nm in a scene, --element-length-nm of "
            "`ropewalk energy`");
    }
  }

  Row parsed() {
    if (csv_.cells().size() != columns_here_)
      fail("", fmt::format("has {} columns", csv_.cells().size()),
           fmt::format("{} are needed, as the header has", columns_here_));
    std::array<double, columns.size()> value{};
    for (std::size_t k = 0; k < columns_here_; ++k) value[k] = number(k);
    std::array<double, columns.size() - 1> numbers;
    std::copy(value.begin() + 1, value.end(), numbers.begin());
    sum_.add(tube_number(value[0]), numbers);
    const Quaternion q(value[4], value[5], value[6], value[7]);
    if (!(std::fabs(q.norm() - 1) <= norm_slack))
      fail("qw", fmt::format("the quaternion has length {:.6g}", q.norm()), "it must be 1 within 0.001");
    return {tube_number(value[0]),
            {value[1], value[2], value[3]},
            std::fabs(q.squaredNorm() - 1) <= norm_rounding ? q : q.normalized(),
            {value[8], value[9], value[10]},
            {value[11], value[12], value[13]}};
  }

  double number(std::size_t k) const {
    const double value = csv_.number(k, columns[k].name);
    if (!(std::fabs(value) <= farthest))
      fail(columns[k].name, fmt::format("is {}", value), fmt::format("must lie within {}", farthest));
    return value;
  }

  int tube_number(double value) const {
    if (value < 0 || value != std::floor(value)) fail("tube", fmt::format("is {}", value), "must be 0, 1, 2, ...");
    return static_cast<int>(value);
  }

  void append_to_tubes(const Row& row) {
    if (rows_.empty() || row.tube != rows_.back().tube) {
      const int next = topology_.tubes() + static_cast<int>(joined_.size());
      if (row.tube < next)
        fail("tube", fmt::format("{} comes again after {}", row.tube, rows_.back().tube),
             "keep the lines of a tube together");
      if (row.tube > next)
        fail("tube", fmt::format("is {}, {} is next", row.tube, next), "number the tubes 0, 1, 2, ... in order");
      if (!rows_.empty() &&
          std::binary_search(broken_.begin(), broken_.end(), static_cast<int>(rows_.size()) - 1)) {
        joined_.push_back(row.tube);
        ++topology_.tube_begin.back();
      } else {
        topology_.add_tube(1);
      }
      return;
    }
    ++topology_.tube_begin.back();
    const double bond = (row.position - rows_.back().position).norm() / element_length_;
    if (bond < shortest_bond || bond > longest_bond)
      fail("", fmt::format("lies {:.3g} nm from the element before it", bond * element_length_),
           fmt::format("elements of a tube follow one another at {:.4g} nm", element_length_));
    // The state of a run that blew up may have such a bond: where the sum is right, the file has.
    if (!far_bond_ && (bond < shortest_single || bond > longest_single))
      far_bond_ = csv_.error(
          "", fmt::format("lies {:.3g} nm from the element before it", bond * element_length_),
          fmt::format(
              "elements of a tube follow one another at {:.4g} nm: is a line missing, or are lengths not in nm?",
              element_length_));
    const Vector3 along = row.position - rows_.back().position;
    if (along.dot(axis_of(rows_.back().orientation)) <= 0 || along.dot(axis_of(row.orientation)) <= 0)
      fail("qw", "the tube folds back: the bond to the element before it stands across or against an axis",
           "turn the quaternions so that the local z of each element points along the tube");
  }

  State state() const {
    State s(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      s.position.set(i, rows_[i].position);
      s.orientation.set(i, rows_[i].orientation);
      s.velocity.set(i, rows_[i].velocity);
      s.angular_velocity.set(i, rows_[i].spin);
    }
    return s;
  }

  std::string path_;
  CsvReader csv_;
  Topology& topology_;
  double element_length_ = topology_.types.front().element_length;
  std::vector<Row> rows_;
  std::size_t columns_here_ = 0;
  bool stated_ = false;     // the file states the length
  std::string stated_sum_;  // empty: the file has none
  StateSum sum_;
  std::optional<InputError> far_bond_;  // the first
  std::vector<int> broken_;             // elements
  std::vector<int> joined_;             // tubes of the file that are the next part of a broken one
};

}  // namespace

std::vector<OutputColumn> state_columns() { return {columns.begin(), columns.end()}; }

void read_state_csv(const std::string& path, Topology& topology, State& state) {
  topology.tube_begin = {0};
  topology.tube_type.clear();
  topology.groups.strand_begin.clear();
  topology.groups.rope_begin.clear();
  topology.groups.strand_holes = 0;
  topology.groups.images = 0;
  state = StateReader(path, topology).read();
}

double state_element_length(const std::string& path) {
  CsvReader csv(path);
  return csv.next() && csv.next() ? stated_length(csv) : 0;
}

StateNotes read_state_notes(const std::string& path) {
  CsvReader csv(path);
  StateNotes notes;
  if (!csv.next() || !csv.next()) return notes;
  notes.broken = stated_breaks(csv);
  for (const std::string_view comment : csv.comments())
    if (comment.rfind(memory_words, 0) == 0) notes.memory = comment.substr(std::string_view(memory_words).size());
  return notes;
}

std::string state_csv(const Topology& topology, const State& s, const StateNotes& notes) {
  std::string text = fmt::format("{}\n# {}{}\n", whole_header, length_words, topology.types.front().element_length);
  if (topology.types.size() > 1) text += fmt::format("# {}{}\n", types_words, fmt::join(topology.tube_type, ","));
  if (!topology.groups.strand_begin.empty())
    text +=
        fmt::format("# {}{}\n", strands_words,
                    fmt::join(topology.groups.strand_begin.begin(), topology.groups.strand_begin.end() - 1, ","));
  if (!topology.groups.rope_begin.empty())
    text += fmt::format("# {}{}\n", ropes_words,
                        fmt::join(topology.groups.rope_begin.begin(), topology.groups.rope_begin.end() - 1, ","));
  if (!notes.memory.empty()) text += fmt::format("# {}{}\n", memory_words, notes.memory);
  if (!notes.broken.empty()) text += fmt::format("# {}{}\n", broken_words, fmt::join(notes.broken, ","));
  std::string rows;
  StateSum sum;
  for (int t = 0; t < topology.tubes(); ++t)
    for (int e = topology.tube_begin[t]; e < topology.tube_begin[t + 1]; ++e) {
      const auto i = static_cast<std::size_t>(e);
      const Vector3 x = s.position[i], v = s.velocity[i], w = s.angular_velocity[i];
      const Quaternion q = s.orientation[i];
      rows += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", t, x.x(), x.y(), x.z(), q.w(), q.x(),
                          q.y(), q.z(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z());
      sum.add(t, {x.x(), x.y(), x.z(), q.w(), q.x(), q.y(), q.z(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z()});
    }
  return text + fmt::format("# {}{}\n", written_words, sum.words()) + rows;
}

}  // namespace ropewalk
