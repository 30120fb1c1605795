#include "ajar/report/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "ajar/report/statistics.h"
#include "markup.h"

namespace ajar {
namespace {

using nlohmann::json;

// Those of the page (report.css) on white.
constexpr const char* colours[] = {"#0072b2", "#d55e00", "#00895f", "#b0478c",
                                   "#8a6d00", "#2f9bd6", "#6a4fb3", "#4d5560"};
// For the methods that the colours do not suffice for, as there; of the first ones none.
constexpr const char* dashes[] = {"", "8 4", "2 3.5"};

/// How the lines of a method are drawn.
struct Stroke {
  const char *colour, *dash;
  bool is_dashed() const { return *dash; }
};
Stroke stroke_of(size_t method) {
  return {colours[method % std::size(colours)], dashes[method / std::size(colours) % std::size(dashes)]};
}

struct Point {
  double time;
  Spread error;
};
/// What the seeds of a method have in common.
struct Line {
  std::string name;
  Stroke stroke;
  bool one_seed;
  std::vector<Point> points;
};

Curve curve_of(const json& run, const char* clock) {
  Curve curve;
  for (const json& s : run.at("samples")) {
    const double time = s.at(clock), error = s.at("relmse_trimmed");
    if (time > 0 && error > 0) curve.push_back({time, error, s.at("spp")});
  }
  return curve;
}

// Over the times that all curves cover: ends of that range, and the first curve's samples in between.
std::vector<Point> common(const std::vector<Curve>& curves) {
  double from = 0, to = INFINITY;
  for (const Curve& c : curves) from = std::max(from, c.front().time), to = std::min(to, c.back().time);
  std::vector<double> times = {from};
  for (const CurvePoint& p : curves[0])
    if (p.time > from && p.time < to) times.push_back(p.time);
  if (to > from) times.push_back(to);
  std::vector<Point> points;
  for (const double t : times) {
    std::vector<double> errors;
    for (const Curve& c : curves)
      if (const auto e = error_at(c, t)) errors.push_back(*e);
    if (const auto s = spread(errors)) points.push_back({t, *s});
  }
  return points;
}

/// What errors are drawn against: what the budget is given in, where all seeds end, so that lines end at the errors of
/// the tables.
struct Clock {
  const char *key, *name;
};
Clock clock_of(const json& budget) {
  if (budget.value("spp", 0.0) > 0) return {"spp", "samples per pixel"};
  if (budget.value("seconds", 0.0) > 0) return {"seconds", "seconds"};
  return {"cpu_seconds", "CPU seconds"};
}

/// Of all methods, in the order in which the page gives them colours.
std::vector<std::string> method_names(const json& results) {
  std::vector<std::string> names;
  for (const json& scene : results.at("scenes"))
    for (const json& method : scene.value("methods", json::array()))
      if (const std::string name = method.at("name"); std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
  return names;
}

std::vector<Line> lines_of(const json& scene, const char* clock, const std::vector<std::string>& names) {
  std::vector<Line> lines;
  for (const json& method : scene.value("methods", json::array())) {
    std::vector<Curve> curves;
    for (const json& run : method.at("runs"))
      if (Curve c = curve_of(run, clock); !c.empty()) curves.push_back(std::move(c));
    if (curves.empty()) continue;
    const std::string name = method.at("name");
    const size_t at = size_t(std::find(names.begin(), names.end(), name) - names.begin());
    lines.push_back({name, stroke_of(at), curves.size() == 1, common(curves)});
  }
  return lines;
}

/// A logarithmic axis: values low and high are at pixels from and to.
struct Axis {
  double low, high, from, to;
  double at(double value) const { return from + (to - from) * std::log(value / low) / std::log(high / low); }
};

struct Tick {
  double value;
  bool named;
};
/// Multiples of the largest 1, 2 or 5 times a power of ten that has enough there.
std::vector<Tick> narrow_ticks(const Axis& axis, size_t fewest) {
  for (int k = int(std::ceil(std::log10(axis.high)));; --k)
    for (const double digit : {5.0, 2.0, 1.0}) {
      const double step = digit * std::pow(10.0, k);
      const int first = int(std::ceil(axis.low / step)), last = int(std::floor(axis.high / step));
      if (last - first + 1 < int(fewest)) continue;
      std::vector<Tick> out;
      for (int i = first; i <= last; ++i) out.push_back({i * step, true});
      return out;
    }
}

/// Decades, and 2 and 5 of them; the latter have names where there are few decades. fewest: names of a narrow axis.
std::vector<Tick> ticks(const Axis& axis, size_t fewest) {
  std::vector<Tick> out;
  const bool few = axis.high / axis.low < 100;
  for (int k = int(std::floor(std::log10(axis.low))); k <= int(std::ceil(std::log10(axis.high))); ++k)
    for (const double digit : {1.0, 2.0, 5.0})
      if (const double v = digit * std::pow(10.0, k); v >= axis.low && v <= axis.high)
        out.push_back({v, few || digit == 1});
  if (few && out.size() < fewest) return narrow_ticks(axis, fewest);
  return out;
}

/// At most so many pixels wide, as the widest of the usual fonts has it.
double width_of(const std::string& text, double font_size) {
  double em = 0;
  for (const char c : text) {
    const auto among = [c](std::string_view letters) { return letters.find(c) != letters.npos; };
    if ((uint8_t(c) & 0xc0) == 0x80) continue;  // belongs to the letter before
    em += among(" !'(),-./:;I[]fijlrt|") ? 0.48 : among("MWmw%@&+<=>#~") || uint8_t(c) >= 0x80 ? 1 : 0.64;
    if (among("ABCDEFGHJKLNOPQRSTUVXYZ")) em += 0.15;
  }
  return em * font_size;
}

/// Without its last letter.
std::string shorter(std::string text) {
  while (!text.empty() && (uint8_t(text.back()) & 0xc0) == 0x80) text.pop_back();
  if (!text.empty()) text.pop_back();
  return text;
}

/// Lines that are no wider, broken at spaces; inside of words that are wider.
std::vector<std::string> wrapped(std::string text, double font_size, double width) {
  std::vector<std::string> lines;
  while (width_of(text, font_size) > width) {
    std::string line = text;
    while (width_of(line, font_size) > width && line.size() > 1) line = shorter(line);
    if (const size_t space = text.rfind(' ', line.size()); space != text.npos && space > 0) line.resize(space);
    text.erase(0, line.size() + (text[line.size()] == ' '));
    lines.push_back(line);
  }
  lines.push_back(text);
  return lines;
}

/// Sizes of a panel, the same for all.
struct Sheet {
  double width, height, names;  ///< names: room for those of methods, beside the plot
  bool keys;                    ///< whether a piece of its line stands before each name
};

/// A scene with its lines.
struct Plot {
  std::string title;
  std::vector<Line> lines;
};

std::string title_of(const json& scene) {
  return fmt::format("{}, {}x{}", scene.at("name").get<std::string>(), scene.at("width").get<int>(),
                     scene.at("height").get<int>());
}

constexpr double key_width = 24, plot_left = 58;

/// Large enough for the longest names, and for as many of them as there are.
Sheet sheet_of(const std::vector<Plot>& plots) {
  constexpr double plot = 262, bold = 1.15;
  Sheet sheet = {0, 290, 100, false};
  for (const Plot& p : plots) {
    sheet.height = std::max(sheet.height, 70 + 13 * double(p.lines.size()));
    sheet.width = std::max(sheet.width, plot_left + 12 + bold * width_of(p.title, 12));
    for (const Line& l : p.lines) {
      sheet.names = std::max(sheet.names, 15 + width_of(l.name, 12));
      sheet.keys |= l.stroke.is_dashed();
    }
  }
  if (sheet.keys) sheet.names += key_width;
  sheet.width = std::max(sheet.width, plot_left + plot + sheet.names);
  return sheet;
}

struct Panel {
  Axis x, y;
};

Panel panel_of(const std::vector<Line>& lines, const Sheet& sheet, double left, double top) {
  double first = INFINITY, last = 0, least = INFINITY, most = 0;
  for (const Line& l : lines)
    for (const Point& p : l.points) {
      first = std::min(first, p.time), last = std::max(last, p.time);
      least = std::min(least, p.error.low), most = std::max(most, p.error.high);
    }
  return {{first / 1.1, last * 1.1, left + plot_left, left + sheet.width - sheet.names},
          {least / 1.25, most * 1.25, top + sheet.height - 42, top + 28}};
}

std::string frame(const Panel& p) {
  std::string out;
  for (const Tick& t : ticks(p.x, 2)) {
    out += fmt::format("<path d='M{0:.1f} {1:.1f}V{2:.1f}' class='{3}'/>\n", p.x.at(t.value), p.y.from, p.y.to,
                       t.named ? "grid" : "faint");
    if (t.named)
      out += fmt::format("<text x='{:.1f}' y='{:.1f}' class='tick' text-anchor='middle'>{:g}</text>\n", p.x.at(t.value),
                         p.y.from + 16, t.value);
  }
  for (const Tick& t : ticks(p.y, 3)) {
    out += fmt::format("<path d='M{0:.1f} {1:.1f}H{2:.1f}' class='{3}'/>\n", p.x.from, p.y.at(t.value), p.x.to,
                       t.named ? "grid" : "faint");
    if (t.named)
      out += fmt::format("<text x='{:.1f}' y='{:.1f}' class='tick' text-anchor='end'>{:g}</text>\n", p.x.from - 6,
                         p.y.at(t.value) + 4, t.value);
  }
  return out;
}

std::string at(const Panel& p, const Point& point, double error) {
  return fmt::format("{:.1f},{:.1f} ", p.x.at(point.time), p.y.at(error));
}

std::string drawn(const Stroke& s) {
  return fmt::format(" stroke='{}'", s.colour) + (s.is_dashed() ? fmt::format(" stroke-dasharray='{}'", s.dash) : "");
}

std::string drawn(const Panel& p, const Line& line) {
  std::string median, band;
  for (const Point& point : line.points)
    median += at(p, point, point.error.median), band += at(p, point, point.error.high);
  for (auto point = line.points.rbegin(); point != line.points.rend(); ++point) band += at(p, *point, point->error.low);
  std::string out;
  if (!line.one_seed) out += fmt::format("<polygon points='{}' fill='{}' opacity='0.15'/>\n", band, line.stroke.colour);
  out += fmt::format("<polyline points='{}'{}/>\n", median, drawn(line.stroke));
  const Point& last = line.points.back();
  return out + fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='2.5' fill='{}'><title>{}: {:.3g}</title></circle>\n",
                           p.x.at(last.time), p.y.at(last.error.median), line.stroke.colour, escaped(line.name),
                           last.error.median);
}

// At the right ends of the lines, pushed apart where they meet.
std::string names(const Panel& p, const std::vector<Line>& lines, bool keys) {
  constexpr double apart = 13;
  struct End {
    const Line* line;
    double y;
  };
  std::vector<End> ends;
  for (const Line& l : lines) ends.push_back({&l, p.y.at(l.points.back().error.median)});
  std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) { return a.y < b.y; });
  for (size_t i = 1; i < ends.size(); ++i) ends[i].y = std::max(ends[i].y, ends[i - 1].y + apart);
  double most = p.y.from;
  for (auto e = ends.rbegin(); e != ends.rend(); ++e, most -= apart) e->y = std::min(e->y, most);
  std::string out;
  for (const End& e : ends) {
    if (keys)
      out += fmt::format("<polyline points='{:.1f},{:.1f} {:.1f},{:.1f}'{}/>\n", p.x.to + 7, e.y,
                         p.x.to + 2 + key_width, e.y, drawn(e.line->stroke));
    out += fmt::format("<text x='{:.1f}' y='{:.1f}' fill='{}'>{}</text>\n", p.x.to + 7 + (keys ? key_width : 0),
                       e.y + 4, e.line->stroke.colour, escaped(e.line->name));
  }
  return out;
}

/// What stands above the panels, and how high it is.
struct Head {
  std::string text;
  double height;
};

Head head_of(const std::string& title, double width) {
  Head head = {"", 20};
  for (const std::string& line : wrapped(title, 14, width - 24)) {
    head.text += fmt::format("<text x='12' y='{}' font-size='14'>{}</text>\n", head.height, escaped(line));
    head.height += 18;
  }
  constexpr const char* says = "relMSE without the worst 0.1 % of pixels; median of the seeds, and their spread";
  for (const std::string& line : wrapped(says, 11, width - 24)) {
    head.text += fmt::format("<text x='12' y='{}' class='tick'>{}</text>\n", head.height, line);
    head.height += 14;
  }
  return head;
}

std::string drawn(const Plot& plot, const Panel& p, const Sheet& sheet, const char* clock) {
  std::string out =
      fmt::format("<text x='{:.1f}' y='{:.1f}' class='name'>{}</text>\n", p.x.from, p.y.to - 9, escaped(plot.title)) +
      frame(p);
  for (const Line& l : plot.lines) out += drawn(p, l);
  return out + names(p, plot.lines, sheet.keys) +
         fmt::format("<text x='{:.1f}' y='{:.1f}' class='tick' text-anchor='middle'>{}</text>\n",
                     (p.x.from + p.x.to) / 2, p.y.from + 32, clock);
}

}  // namespace

std::string curves_svg(const json& results) {
  const Clock clock = clock_of(results.at("budget"));
  const std::vector<std::string> methods = method_names(results);
  std::vector<Plot> plots;
  for (const json& scene : results.at("scenes"))
    if (std::vector<Line> lines = lines_of(scene, clock.key, methods); !lines.empty())
      plots.push_back({title_of(scene), std::move(lines)});
  if (plots.empty()) return {};
  const Sheet sheet = sheet_of(plots);
  const double width = sheet.width * double(std::min<size_t>(plots.size(), 2));
  const Head head = head_of(results.value("title", ""), width);
  const double height = head.height + sheet.height * double((plots.size() + 1) / 2);
  std::string panels;
  for (size_t n = 0; n < plots.size(); ++n) {
    const double left = sheet.width * double(n % 2), top = head.height + sheet.height * double(n / 2);
    panels += drawn(plots[n], panel_of(plots[n].lines, sheet, left, top), sheet, clock.name);
  }
  return fmt::format(
             "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' height='{1:.0f}' "
             "font-family='sans-serif' font-size='12'>\n"
             "<style>polyline{{fill:none;stroke-width:2}}.grid{{stroke:#d5d9df}}.faint{{stroke:#eef0f3}}"
             ".tick{{fill:#5b6470;font-size:11px}}.name{{font-weight:bold}}</style>\n"
             "<rect width='{0:.0f}' height='{1:.0f}' fill='white'/>\n",
             width, height) +
         head.text + panels + "</svg>\n";
}

}  // namespace ajar
