#include "ajar/report/sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "ajar/report/json.h"
#include "markup.h"
#include "planes.h"

namespace ajar {
namespace {

using Figure = std::function<double(const FrameFigures&)>;

double mean_over(const std::vector<FrameFigures>& frames, const Figure& figure) {
  double sum = 0;
  int n = 0;
  for (const FrameFigures& f : frames)
    if (const double x = figure(f); !std::isnan(x)) sum += x, ++n;
  return n > 0 ? sum / n : NAN;
}

nlohmann::ordered_json known(double x) { return std::isnan(x) ? nlohmann::ordered_json() : nlohmann::ordered_json(x); }
std::string cell(double x) { return std::isnan(x) ? "" : fmt::format("{}", x); }

// Quoted where it would fall apart (RFC 4180).
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + '"';
}

// A figure over frames, logarithmic; one part of the plot.
struct FramePlot {
  double left = 70, top = 0, width = 600, height = 170;
  double first = 0, last = 1;  // frames
  double low = 0, high = 1;    // decades

  double x(double frame) const { return left + width * (frame - first) / std::max(last - first, 1.0); }
  double y(double value) const { return top + height * (high - std::log10(value)) / (high - low); }
};

std::string draw(FramePlot p, const std::vector<FrameFigures>& frames, const std::string& name, const Figure& figure) {
  double least = INFINITY, most = 0;
  for (const FrameFigures& f : frames)
    if (const double v = figure(f); v > 0) least = std::min(least, v), most = std::max(most, v);
  if (!(most > 0)) least = most = 1;
  p.low = std::floor(std::log10(least)), p.high = std::max(std::ceil(std::log10(most)), p.low + 1);
  std::string out = fmt::format("<text x='{}' y='{}' class='name'>{}</text>\n", p.left, p.top - 8, escaped(name));
  for (double decade = p.low; decade <= p.high; ++decade) {
    const double y = p.y(std::pow(10, decade));
    out +=
        fmt::format("<line x1='{}' x2='{}' y1='{:.1f}' y2='{:.1f}' class='grid'/>\n", p.left, p.left + p.width, y, y);
    out += fmt::format("<text x='{}' y='{:.1f}' class='tick' text-anchor='end'>{:g}</text>\n", p.left - 6, y + 4,
                       std::pow(10, decade));
  }
  std::string line;
  for (const FrameFigures& f : frames) {
    const double v = figure(f);
    if (!(v > 0)) continue;
    line += fmt::format("{:.1f},{:.1f} ", p.x(f.frame), p.y(v));
    out += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='2.5'><title>frame {}: {:.4g}</title></circle>\n",
                       p.x(f.frame), p.y(v), f.frame, v);
  }
  out += fmt::format("<polyline points='{}'/>\n", line);
  for (const double frame : {p.first, p.last})
    out += fmt::format("<text x='{:.1f}' y='{}' class='tick' text-anchor='middle'>{}</text>\n", p.x(frame),
                       p.top + p.height + 16, frame);
  return out;
}

}  // namespace

double flicker(const Picture& before, const Picture& now, const Picture& reference_before,
               const Picture& reference_now) {
  for (const Picture* p : {&before, &reference_before, &reference_now}) require_same_size(now, *p);
  const auto a = rgb_planes(before), b = rgb_planes(now), ra = rgb_planes(reference_before),
             rb = rgb_planes(reference_now);
  double sum = 0;
  for (size_t c = 0; c < 3; ++c)
    for (size_t i = 0; i < a[c].size(); ++i) {
      const double change = double(b[c][i]) - a[c][i], true_change = double(rb[c][i]) - ra[c][i];
      sum += (change - true_change) * (change - true_change) / (double(rb[c][i]) * rb[c][i] + 0.01);
    }
  return sum / (3 * double(a[0].size()));
}

SequenceFigures mean_of(const std::vector<FrameFigures>& frames) {
  SequenceFigures m;
  m.seconds = mean_over(frames, [](const FrameFigures& f) { return f.seconds; });
  m.cpu_seconds = mean_over(frames, [](const FrameFigures& f) { return f.cpu_seconds; });
  m.spp = mean_over(frames, [](const FrameFigures& f) { return f.spp; });
  m.relmse = mean_over(frames, [](const FrameFigures& f) { return f.relmse; });
  m.relmse_trimmed = mean_over(frames, [](const FrameFigures& f) { return f.relmse_trimmed; });
  m.flicker = mean_over(frames, [](const FrameFigures& f) { return f.flicker; });
  return m;
}

std::string sequence_json(const std::vector<FrameFigures>& frames) {
  const SequenceFigures m = mean_of(frames);
  nlohmann::ordered_json j;
  j["frames_done"] = frames.size();
  j["mean"] = {
      {"seconds", known(m.seconds)}, {"cpu_seconds", known(m.cpu_seconds)},       {"spp", known(m.spp)},
      {"relmse", known(m.relmse)},   {"relmse_trimmed", known(m.relmse_trimmed)}, {"flicker", known(m.flicker)}};
  j["frames"] = nlohmann::ordered_json::array();
  for (const FrameFigures& f : frames)
    j["frames"].push_back({{"frame", f.frame},
                           {"parameters", f.parameters},
                           {"seconds", f.seconds},
                           {"cpu_seconds", f.cpu_seconds},
                           {"spp", f.spp},
                           {"mean", f.mean},
                           {"relmse", known(f.relmse)},
                           {"relmse_trimmed", known(f.relmse_trimmed)},
                           {"flicker", known(f.flicker)}});
  return text_of(j, 2) + "\n";
}

namespace {

// The column of a parameter, one of names; one that is called like a figure has a longer name.
std::string column_of(const std::string& parameter, const std::set<std::string>& names) {
  static constexpr const char* figures[] = {"frame", "seconds", "cpu_seconds",    "spp",
                                            "mean",  "relmse",  "relmse_trimmed", "flicker"};
  const bool taken = std::find(std::begin(figures), std::end(figures), parameter) != std::end(figures);
  std::string column = parameter;
  while (taken && (column == parameter || names.count(column) > 0)) column = "parameter_" + column;
  return cell(column);
}

}  // namespace

std::string sequence_csv(const std::vector<FrameFigures>& frames) {
  std::set<std::string> names;
  for (const FrameFigures& f : frames)
    for (const auto& [name, value] : f.parameters) names.insert(name);
  std::string out = "frame";
  for (const std::string& name : names) (out += ",") += column_of(name, names);
  out += ",seconds,cpu_seconds,spp,mean,relmse,relmse_trimmed,flicker\n";
  for (const FrameFigures& f : frames) {
    out += fmt::format("{}", f.frame);
    for (const std::string& name : names) {
      const auto found = f.parameters.find(name);
      out += fmt::format(",{}", found == f.parameters.end() ? "" : cell(found->second));
    }
    for (const double x : {f.seconds, f.cpu_seconds, f.spp, f.mean, f.relmse, f.relmse_trimmed, f.flicker})
      out += fmt::format(",{}", cell(x));
    out += "\n";
  }
  return out;
}

std::string sequence_svg(const std::vector<FrameFigures>& frames, const std::string& title) {
  FramePlot p;
  if (!frames.empty()) p.first = frames.front().frame, p.last = frames.back().frame;
  std::string out =
      "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 700 500' font-family='sans-serif' font-size='12'>\n"
      "<style>polyline{fill:none;stroke:#2166ac;stroke-width:1.5}circle{fill:#2166ac}.grid{stroke:#ddd}"
      ".tick{fill:#666;font-size:11px}.name{font-weight:bold}</style>\n<rect width='700' height='500' fill='white'/>\n";
  out += fmt::format("<text x='70' y='24' font-size='14'>{}</text>\n", escaped(title));
  const SequenceFigures mean = mean_of(frames);
  const auto panel = [&](const std::string& name, double of, const Figure& figure, double top) {
    p.top = top;
    const std::string average = std::isnan(of) ? "" : fmt::format(", {:.3g} on average", of);
    out += draw(p, frames, fmt::format("{} per frame{}", name, average), figure);
  };
  if (std::isnan(mean.relmse)) {
    panel(
        "mean of the image", mean_over(frames, [](const FrameFigures& f) { return f.mean; }),
        [](const FrameFigures& f) { return f.mean; }, 70);
    panel(
        "seconds", mean.seconds, [](const FrameFigures& f) { return f.seconds; }, 290);
  } else {
    panel(
        "relMSE", mean.relmse, [](const FrameFigures& f) { return f.relmse; }, 70);
    panel(
        "flicker", mean.flicker, [](const FrameFigures& f) { return f.flicker; }, 290);
  }
  return out + "</svg>\n";
}

}  // namespace ajar
