// `ropewalk view`: the page in Chromium, without a graphics card, and the movie.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "cli/support.hpp"
#include "io/base64.hpp"
#include "io/log.hpp"

namespace {
namespace UNIT {

using ropewalk::test::Outcome;
using ropewalk::test::slurp;
using ropewalk::test::spit;
namespace fs = std::filesystem;

bool installed(const char* program) {
  return std::system((std::string("command -v ") + program + " > /dev/null 2>&1").c_str()) == 0;
}

struct Browsed {
  std::string dom, errors;
  std::set<std::string> asked;  // addresses that the page asked for

  std::string console() const {
    std::string lines, line;
    for (std::istringstream in(errors); std::getline(in, line);)
      if (line.find("CONSOLE") != std::string::npos) lines += line + "\n";
    return lines;
  }
  // The text of the element with this mark, such as id="check".
  std::string text(const std::string& mark) const {
    const std::size_t at = dom.find(mark), begin = dom.find('>', at) + 1;
    return at == std::string::npos ? "" : dom.substr(begin, dom.find('<', begin) - begin);
  }
  bool has(const std::string& words) const { return dom.find(words) != std::string::npos; }
};

class View : public ropewalk::test::Cli {
 protected:
  void run_rope() const {
    spit(
        dir / "s.toml",
        "format = \"ropewalk-scene-1\"\nname = \"rope <1>\"\nparameters = \"cnt-10-10-paper\"\n[rope]\ntubes = 19\n"
        "length_nm = 16\nperturbation_nm = 0.001\n[twist]\nmoment_nN_nm = 30\nrate_nN_nm_per_ps = 10\nhold_ps = 2\n"
        "[run]\nlog_every_ps = 1\nframes_every_ps = 1\n");
    const Outcome o = run("run s.toml --out d --quiet");
    ASSERT_EQ(o.code, 0) << o.err;
  }

  // Chromium's own addresses are left out: it asks for updates whatever it is told.
  Browsed browse(const std::string& file, const std::string& hash = "",
                 const std::string& more = "--dump-dom") const {
    const std::string net = (dir / "net.json").string();
    const std::string command = fmt::format(
        "chromium --no-sandbox --headless --use-angle=swiftshader --enable-unsafe-swiftshader --hide-scrollbars "
        "--disable-background-networking --no-first-run '--host-resolver-rules=MAP * ~NOTFOUND' "
        "--user-data-dir='{0}/chromium' --log-net-log='{1}' --virtual-time-budget=8000 --enable-logging=stderr {2} "
        "'file://{0}/{3}{4}' > '{0}/dom.html' 2> '{0}/browser.txt' < /dev/null",
        dir.string(), net, more, file, hash);
    EXPECT_EQ(std::system(command.c_str()), 0) << slurp(dir / "browser.txt");
    Browsed out{slurp(dir / "dom.html"), slurp(dir / "browser.txt"), {}};
    const std::string log = slurp(net);
    const std::regex address("\"url\":\"([^\"]*)\""), own("https?://[^/]*\\.(google|googleapis|gvt1)\\.com/.*");
    for (std::sregex_iterator at(log.begin(), log.end(), address), end; at != end; ++at)
      if (!std::regex_match((*at)[1].str(), own)) out.asked.insert((*at)[1]);
    return out;
  }
};

// Chromium's virtual time does not wait for threads that unpack or decode: on a busy machine it may look too early.
template <class Look, class Settled>
auto looked(const Look& look, const Settled& settled) {
  auto seen = look();
  for (int again = 0; again < 6 && !settled(seen); ++again) seen = look();
  return seen;
}
bool is_settled(const Browsed& page) { return page.has("data-state="); }

#define NEEDS_CHROMIUM \
  if (!installed("chromium")) GTEST_SKIP() << "Chromium is not installed"

TEST_F(View, ThePageShowsTheNumbersOfTheLog) {
  NEEDS_CHROMIUM;
  run_rope();
  const Outcome o = run("view d");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("d/view.html written: 6 of 6 frames"), std::string::npos) << o.out;
  EXPECT_NE(slurp(dir / "d/report.html").find("<a href=\"view.html\">"), std::string::npos);

  const auto log = ropewalk::read_log((dir / "d/log.csv").string());
  const auto thin_groups = [](std::string text) {
    if (text.size() > 8 || (text.size() == 8 && text[0] != '-')) text.insert(text.find('.') - 3, "\u2009");
    return text[0] == '-' ? "−" + text.substr(1) : text;
  };
  for (const std::size_t row : {std::size_t{2}, log.size() - 1}) {
    const Browsed page =
        looked([&] { return browse("d/view.html", fmt::format("#frame={}&colour=van der Waals energy", row + 1)); },
               is_settled);
    EXPECT_TRUE(page.has("data-state=\"ready\"")) << page.text("id=\"failure\"") << page.console();
    EXPECT_EQ(page.console(), "");
    EXPECT_EQ(page.asked, std::set<std::string>());
    EXPECT_TRUE(page.has("<h1>rope &lt;1&gt;</h1>"));
    // Checked by the page itself, with the sums of both energies of all six frames against log.csv.
    EXPECT_NE(page.text("id=\"check\"").find("12 sums of energies agree with log.csv"), std::string::npos)
        << page.text("id=\"check\"");
    const double vdw = log[row]["vdw_eV"];
    ASSERT_LT(vdw, -100);
    const int decimals = vdw > -1000 ? 3 : 2;
    EXPECT_EQ(page.text("data-number=\"total\""), thin_groups(fmt::format("{:.{}f}", vdw, decimals)));
    EXPECT_NE(page.text("id=\"when\"").find(fmt::format("{:.3f} ps", log[row]["time_ps"])), std::string::npos)
        << page.text("id=\"when\"");
  }
}

// Links that hold are counted, frame by frame.
TEST_F(View, LinksAreThereAsLongAsTheyHold) {
  NEEDS_CHROMIUM;
  spit(dir / "s.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 20\n"
       "[[links]]\nper_nm = 0.3\nstiffness_nN_per_nm = 40\nbreaks_at_nN = 1\n"
       "[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\ntubes = [0]\nz = { displacement_nm = [[0, 0], [20, "
       "2]] }\n"
       "[run]\nduration_ps = 20\nlog_every_ps = 5\nframes_every_ps = 5\n");
  const Outcome o = run("run s.toml --out d --quiet");
  ASSERT_EQ(o.code, 0) << o.err;
  const std::string events = slurp(dir / "d/events.csv");
  const auto count = [&](const std::string& what) {
    std::size_t n = 0;
    for (std::size_t at = events.find(what); at != std::string::npos; at = events.find(what, at + 1)) ++n;
    return n;
  };
  const std::size_t formed = count(",link formed,"), broken = count(",link broke,");
  ASSERT_GT(broken, 0u);
  ASSERT_GT(formed, broken);
  EXPECT_NE(o.out.find("Stress "), std::string::npos) << o.out;
  EXPECT_NE(o.out.find(fmt::format("{} of {} links broke.", broken, formed)), std::string::npos) << o.out;
  ASSERT_EQ(run("view d").code, 0);
  const auto links_at = [&](const std::string& hash) {
    const Browsed page = looked([&] { return browse("d/view.html", hash); }, is_settled);
    EXPECT_EQ(page.console(), "");
    return page.text("id=\"links\"");
  };
  EXPECT_EQ(links_at("#frame=1"), fmt::format("links (red): {}", formed));
  EXPECT_EQ(links_at(""), fmt::format("links (red): {}", formed - broken)) << "the last frame";
  EXPECT_NE(slurp(dir / "d/report.html").find("Red: links"), std::string::npos);
}

// A tube that breaks is two tubes of the page, which meet as long as it holds.
TEST_F(View, TubesThatBreakAreDrawnInTheirParts) {
  NEEDS_CHROMIUM;
  spit(dir / "s.toml",
       "format = \"ropewalk-scene-1\"\nparameters = \"cnt-10-10-tersoff\"\n[rope]\ntubes = 7\nlength_nm = 20\n"
       "[failure]\nstrain = 0.05\n[limits]\nstrain = 0.02\n[[grip]]\nend = \"lower\"\n[[grip]]\nend = \"upper\"\nz "
       "= { "
       "strain = [[0, 0], "
       "[20, "
       "0.1]] }\n[run]\nduration_ps = 20\nlog_every_ps = 5\nframes_every_ps = 5\n");
  const Outcome o = run("run s.toml --out d --quiet");
  ASSERT_EQ(o.code, 0) << o.err;
  const std::string events = slurp(dir / "d/events.csv");
  ASSERT_NE(events.find(",tube broke,"), std::string::npos);
  const auto breaks = std::count(events.begin(), events.end(), '\n') - 1;
  ASSERT_EQ(run("view d").code, 0);
  const std::string page = slurp(dir / "d/view.html"), key = "\"tube_begin\":[";
  const std::size_t from = page.find(key), to = page.find(']', from);
  EXPECT_EQ(std::count(page.begin() + static_cast<long>(from), page.begin() + static_cast<long>(to), ','),
            7 + breaks);
  // Places are those of the scene, whatever the parts; a passed limit is one of them.
  const Browsed there = looked([&] { return browse("d/view.html", "#tube=6&element=13"); }, is_settled);
  EXPECT_EQ(there.console(), "");
  EXPECT_EQ(there.text("id=\"gone\""), "tube 6, element 13");
  EXPECT_TRUE(there.has("data-mark=\"strain\">strain, from ")) << there.text("id=\"marks\"");
  EXPECT_EQ(looked([&] { return browse("d/view.html", "#tube=7"); }, is_settled).text("id=\"gone\""),
            "the tubes are 0 to 6");
  for (const char* frame : {"#frame=1", ""}) {
    const Browsed seen = looked([&] { return browse("d/view.html", frame); }, is_settled);
    EXPECT_EQ(seen.console(), "") << "the page finds the extremes and sums of the frame again";
  }
}

TEST_F(View, ADamagedPageSaysSo) {
  NEEDS_CHROMIUM;
  run_rope();
  ASSERT_EQ(run("view d -o page.html").code, 0);
  const std::string page = slurp(dir / "page.html");
  std::string other_sum = page;
  const std::size_t total = other_sum.find("\"total\":[") + 9;
  other_sum.insert(total, "9");
  spit(dir / "other-sum.html", other_sum);
  const Browsed sum = looked([&] { return browse("other-sum.html"); }, is_settled);
  EXPECT_TRUE(sum.has("data-state=\"failed\""));
  EXPECT_NE(sum.text("id=\"failure\"").find("the sum of Bending moment is"), std::string::npos);

  std::string cut = page;
  const std::size_t frames = cut.find("id=\"frames\">") + 12;
  cut.erase(frames + 400, 400);
  spit(dir / "cut.html", cut);
  EXPECT_TRUE(looked([&] { return browse("cut.html"); }, is_settled).has("data-state=\"failed\""));
}

// Pixels of the stage that are neither grey nor the page's own: tubes, in light and in dark, whole and cut.
TEST_F(View, TheStageIsNotBlank) {
  NEEDS_CHROMIUM;
  run_rope();
  ASSERT_EQ(run("view d").code, 0);
  const auto coloured_once = [&](const std::string& hash, const std::string& more) {
    browse("d/view.html", hash,
           fmt::format("--window-size=1300,900 --screenshot='{}/shot.png' {}", dir.string(), more));
    // A page that counts: the browser itself reads its picture.
    spit(dir / "count.html", R"(<p id="count"></p><script>(async () => {
      const i = new Image(); i.src = 'data:image/png;base64,)" +
                                 ropewalk::base64(slurp(dir / "shot.png")) +
                                 R"('; await i.decode();
      const c = document.createElement('canvas'); c.width = i.width; c.height = i.height;
      const g = c.getContext('2d'); g.drawImage(i, 0, 0);
      const d = g.getImageData(40, 120, i.width - 80, 440).data;
      const shades = new Set(); let n = 0;
      for (let k = 0; k < d.length; k += 4) {
        const spread = Math.max(d[k], d[k + 1], d[k + 2]) - Math.min(d[k], d[k + 1], d[k + 2]);
        if (spread > 40) { ++n; shades.add(d[k] << 16 | d[k + 1] << 8 | d[k + 2]); }
      }
      document.getElementById('count').textContent = [n / d.length * 400, shades.size].join(' ');
    })();</script>)");
    std::istringstream in(looked([&] { return browse("count.html"); },
                                 [](const Browsed& page) { return !page.text("id=\"count\"").empty(); })
                              .text("id=\"count\""));
    std::pair<double, int> out{0, 0};
    in >> out.first >> out.second;
    return out;
  };
  const auto coloured = [&](const std::string& hash, const std::string& more) {
    return looked([&] { return coloured_once(hash, more); }, [](const auto& out) { return out.first > 1; });
  };
  // The rope is some 16 nm long and 7 nm thick. Many shades: it is lit.
  const auto whole = coloured("#colour=Shell&look=side", "");
  EXPECT_GT(whole.first, 15) << "percent of the stage";
  EXPECT_GT(whole.second, 200);
  const auto half = coloured("#colour=Shell&look=side&cut=right&at=0.5", "");
  EXPECT_GT(half.first, 0.3 * whole.first);
  EXPECT_LT(half.first, 0.7 * whole.first);
  const auto dark = coloured("#colour=Shell&look=side", "--blink-settings=preferredColorScheme=0");
  EXPECT_GT(dark.first, 15);
}

// The test of the test: what a page asks for is seen.
TEST_F(View, AnAddressThatAPageAsksForIsSeen) {
  NEEDS_CHROMIUM;
  spit(dir / "asks.html", "<img src=\"http://elsewhere.invalid/x.png\">");
  EXPECT_EQ(browse("asks.html").asked, std::set<std::string>{"http://elsewhere.invalid/x.png"});
}

TEST_F(View, AReportLinksOnlyAPageThatIsNotOlderThanTheFrames) {
  run_rope();
  const auto linked = [&] { return slurp(dir / "d/report.html").find("href=\"view.html\"") != std::string::npos; };
  EXPECT_FALSE(linked());
  ASSERT_EQ(run("view d --frames 2").code, 0);
  EXPECT_TRUE(linked());
  fs::last_write_time(dir / "d/frames.gsd", fs::file_time_type::clock::now() + std::chrono::hours(1));
  ASSERT_EQ(run("report d").code, 0);
  EXPECT_FALSE(linked());
}

TEST_F(View, WrongOptionsAreOneLine) {
  run_rope();
  for (const char* line : {"view", "view nowhere", "view d --frames 0", "view d --fps 3", "view d --movie m.gif",
                           "view d --movie m", "view d -o s.toml", "view d --movie m.webm --from below"}) {
    const Outcome o = run(line, "PATH=$PWD/bin:$PATH");
    EXPECT_EQ(o.code, 2) << line;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << line << "\n" << o.err;
  }
  const Outcome o = run("view d --movie m.webm", "PATH=./nowhere");
  EXPECT_EQ(o.code, 2);
  EXPECT_EQ(o.err, "ropewalk: --movie: needs ffmpeg, which is missing or does not work; install ffmpeg\n");
  EXPECT_FALSE(fs::exists(dir / "m.webm.frames"));
}

// A stand-in for ffmpeg keeps the pictures that it gets.
TEST_F(View, AMovieIsMadeOfPicturesOfOneSize) {
  run_rope();
  fs::create_directory(dir / "bin");
  spit(dir / "bin/ffmpeg",
       "#!/bin/sh\nfor last; do [ \"$word\" = -i ] && from=$last; word=$last; done\n[ \"$last\" = - ] && exit 0\n"
       "cp -r \"$(dirname \"$from\")\" kept && echo \"$@\" > \"$last\"\n");
  fs::permissions(dir / "bin/ffmpeg", fs::perms::owner_all);
  const Outcome o = run("view d --movie m.webm --frames 3 --fps 7.5 --width 801", "PATH=$PWD/bin:$PATH");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NE(slurp(dir / "m.webm").find("-framerate 7.5"), std::string::npos);
  EXPECT_FALSE(fs::exists(dir / "m.webm.frames"));
  std::set<std::string> sizes, pictures;
  for (const char* name : {"000000", "000001", "000002"}) {
    const std::string png = slurp(dir / "kept" / (std::string(name) + ".png"));
    ASSERT_GT(png.size(), 5000u) << name;
    sizes.insert(png.substr(16, 8));  // width and height
    pictures.insert(png);
    EXPECT_EQ(png.substr(16, 4), std::string("\0\0\x3\x22", 4)) << "802 pixels: codecs want even numbers";
    EXPECT_EQ(png[23] % 2, 0);
  }
  EXPECT_FALSE(fs::exists(dir / "kept/000003.png"));
  EXPECT_EQ(sizes.size(), 1u);
  EXPECT_EQ(pictures.size(), 3u) << "the rope moves";
  // A movie that cannot be joined leaves the old one.
  spit(dir / "bin/ffmpeg", "#!/bin/sh\nfor last; do :; done\n[ \"$last\" = - ]\n");
  const std::string before = slurp(dir / "m.webm");
  EXPECT_EQ(run("view d --movie m.webm --force --frames 2", "PATH=$PWD/bin:$PATH").code, 2);
  EXPECT_EQ(slurp(dir / "m.webm"), before);
}

TEST_F(View, FfmpegTakesTheMovie) {
  if (!installed("ffmpeg")) GTEST_SKIP() << "ffmpeg is not installed";
  run_rope();
  ASSERT_EQ(run("view d --movie m.webm --frames 3 --from 30,20 --width 400").code, 0);
  EXPECT_EQ(slurp(dir / "m.webm").substr(0, 4), "\x1a\x45\xdf\xa3");
  ASSERT_EQ(run("view d --movie m.mp4 --frames 3 --from end --width 400").code, 0);
  EXPECT_EQ(slurp(dir / "m.mp4").substr(4, 4), "ftyp");
}

}  // namespace UNIT
}  // namespace
