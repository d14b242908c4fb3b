#include "report/view/view_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <random>

#include "io/base64.hpp"
#include "report/page.hpp"
#include "report/view/pack.hpp"
#include "report/view/view_files.hpp"

namespace ropewalk {
namespace {

using Json = nlohmann::ordered_json;

constexpr int most_levels = no_number_code - 1, fewest_levels = 1000;
constexpr double finest_position = 0.001;  // nm: nobody sees less
constexpr std::size_t checked_numbers = 64;

template <class T>
std::vector<T> chosen(const std::vector<T>& all, const std::vector<std::size_t>& frames) {
  std::vector<T> out;
  for (const std::size_t f : frames) out.push_back(all[f]);
  return out;
}

ViewInput with_frames(const ViewInput& in, const std::vector<std::size_t>& frames) {
  ViewInput out = in;
  out.time_ps = chosen(in.time_ps, frames);
  out.step = chosen(in.step, frames);
  out.joints = chosen(in.joints, frames);
  for (ViewField& f : out.fields) {
    f.values = chosen(f.values, frames);
    f.log_total = chosen(f.log_total, frames);
  }
  return out;
}

Json as_json(const Vector3& v) { return {v.x(), v.y(), v.z()}; }

// One coordinate of all joints.
std::vector<std::vector<double>> coordinate(const ViewInput& in, int k) {
  std::vector<std::vector<double>> out;
  for (const auto& joints : in.joints) {
    out.emplace_back();
    for (const Vector3& p : joints) out.back().push_back(p[k]);
  }
  return out;
}

// The value that this part of all numbers does not exceed.
double quantile(std::vector<double> all, double part) {
  if (all.empty()) return 0;
  const auto at = all.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(all.size() - 1));
  std::nth_element(all.begin(), at, all.end());
  return *at;
}

// Ends of the colours. They leave out the outermost values, or one kinked bond would make all others look alike.
std::pair<double, double> colour_range(const ViewField& field) {
  std::vector<double> all;
  for (const auto& frame : field.values)
    std::copy_if(frame.begin(), frame.end(), std::back_inserter(all), [](double v) { return std::isfinite(v); });
  double low = quantile(all, 0.005), high = quantile(all, 0.995);
  if (field.is_signed) {
    high = std::max(std::abs(low), std::abs(high));
    low = -high;
  } else if (low > 0 && low < 0.5 * high) {
    low = 0;
  }
  return {low, high};
}

Json as_json(const ViewField& field, const CodeScale& scale) {
  const auto [low, high] = colour_range(field);
  Json out = {{"name", field.name},
              {"unit", field.unit},
              {"meaning", field.meaning},
              {"signed", field.is_signed},
              {"low", scale.low},
              {"step", scale.step},
              {"from", low},
              {"to", high},
              {"total", Json::array()},
              {"least", Json::array()},
              {"most", Json::array()},
              {"log", Json::array()}};
  for (std::size_t f = 0; f < field.values.size(); ++f) {
    double sum = 0, least = std::numeric_limits<double>::infinity(), most = -least;
    for (const double v : field.values[f])
      if (std::isfinite(v)) sum += v, least = std::min(least, v), most = std::max(most, v);
    out["total"].push_back(sum);
    out["least"].push_back(least);
    out["most"].push_back(most);
    out["log"].push_back(field.log_total[f]);
  }
  return out;
}

// Some numbers as they were before they were rounded: the page compares what it has unpacked with them.
Json numbers_to_check(const ViewInput& in) {
  Json out = Json::array();
  const std::size_t elements = static_cast<std::size_t>(in.tube_begin.back());
  for (std::size_t k = 0; k < checked_numbers; ++k) {
    const std::size_t frame = k * in.time_ps.size() / checked_numbers, element = k * 7919 % elements;
    Json values = Json::array();
    for (const ViewField& f : in.fields) values.push_back(f.values[frame][element]);
    const std::size_t joint = k * 7919 % in.joints[frame].size();
    out.push_back({{"frame", frame},
                   {"element", element},
                   {"values", values},
                   {"joint", joint},
                   {"position", as_json(in.joints[frame][joint])}});
  }
  return out;
}

// JSON in a <script>: `<` stands in strings alone, and unescaped it could end the script or begin a comment in it.
std::string in_script(const std::string& json) {
  std::string out;
  for (const char c : json) c == '<' ? out += "\\u003c" : out += c;
  return out;
}

// The template with a text in the place of each {{mark}}. Texts are not looked at for marks.
std::string filled(std::string_view page, const std::map<std::string, std::string, std::less<>>& texts) {
  std::string out;
  for (std::size_t at; (at = page.find("{{")) != std::string_view::npos;) {
    const std::size_t end = page.find("}}", at);
    out += page.substr(0, at);
    out += texts.at(std::string(page.substr(at + 2, end - at - 2)));
    page.remove_prefix(end + 2);
  }
  return out += page;
}

// Only scripts that carry it run. Whoever chose the names in a page cannot know it.
std::string random_nonce() {
  std::random_device random;
  std::string bytes;
  for (int k = 0; k < 16; ++k) bytes += static_cast<char>(random() & 0xff);
  return base64(bytes);
}

ViewPage page_with(const ViewInput& in, int levels) {
  ViewPage out;
  out.frames = in.time_ps.size();
  out.levels = levels;
  std::vector<int> joint_begin = in.tube_begin, every_tube;
  for (std::size_t t = 0; t < joint_begin.size(); ++t) joint_begin[t] += static_cast<int>(t);

  Packer packer;
  Json position = {{"low", Json::array()}};
  out.position_step = finest_position;
  for (int k = 0; k < 3; ++k)
    out.position_step = std::max(out.position_step, code_scale(coordinate(in, k), most_levels).step);
  for (int k = 0; k < 3; ++k) {
    const auto all = coordinate(in, k);
    const CodeScale scale{code_scale(all, most_levels).low, out.position_step};
    packer.add(all, joint_begin, scale, 2);
    position["low"].push_back(scale.low);
  }
  position["step"] = out.position_step;
  Json fields = Json::array(), numbers = Json::array(), colours = Json::array();
  for (const ViewField& f : in.fields) {
    const CodeScale scale = code_scale(f.values, levels);
    packer.add(f.values, in.tube_begin, scale, 1);
    fields.push_back(as_json(f, scale));
  }
  for (const ViewTubeNumber& n : in.tube_numbers)
    numbers.push_back({{"name", n.name}, {"meaning", n.meaning}, {"values", n.values}});
  Json links = Json::array();  // infinity is null in JSON
  for (const ViewLink& l : in.links) links.push_back({l.a, l.b, l.formed, l.broke});
  Json marks = Json::array();
  for (const ViewMark& m : in.marks)
    marks.push_back({{"limit", m.limit}, {"held_by", m.held_by}, {"time_ps", m.time_ps}, {"element", m.element}});
  for (int k = 0; k <= 8; ++k) colours.push_back(viridis(k / 8.0));
  const Json facts = {{"name", in.name},
                      {"time_ps", in.time_ps},
                      {"step", in.step},
                      {"stored_frames", in.stored_frames},
                      {"tube_begin", in.tube_begin},
                      {"piece_of", in.piece_of},
                      {"tube_radius", in.tube_radius},
                      {"position", position},
                      {"fields", fields},
                      {"tube_numbers", numbers},
                      {"links", links},
                      {"marks", marks},
                      {"right", as_json(in.camera.right)},
                      {"up", as_json(in.camera.up)},
                      {"towards", as_json(in.camera.towards)},
                      {"colours", colours},
                      {"check", numbers_to_check(in)}};

  const std::string nonce = random_nonce();
  out.html =
      scripted_page_head(in.name, view_css, nonce) + filled(view_body_html, {{"name", escape_markup(in.name)},
                                                                             {"nonce", nonce},
                                                                             {"three.js", three_js},
                                                                             {"OrbitControls.js", three_orbit_js},
                                                                             {"facts", in_script(facts.dump())},
                                                                             {"frames", base64(packer.deflated())},
                                                                             {"scripts", view_js}});
  return out;
}

}  // namespace

bool can_make_view() { return three_js[0] != '\0' && three_orbit_js[0] != '\0'; }

ViewPage view_page(const ViewInput& input, std::size_t max_bytes) {
  const int rounded = 4095;
  for (const int levels : {most_levels, rounded, fewest_levels}) {
    ViewPage page = page_with(input, levels);
    if (page.html.size() <= max_bytes) return page;
  }
  ViewInput in = input;
  ViewPage page;
  do {
    in = with_frames(in, evenly(in.time_ps.size(), std::max<std::size_t>(1, in.time_ps.size() / 2)));
    page = page_with(in, fewest_levels);
  } while (page.html.size() > max_bytes && page.frames > 1);
  return page;
}

}  // namespace ropewalk
