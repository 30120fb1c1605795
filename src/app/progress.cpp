#include "progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

namespace ajar {
namespace {

// By the limit that comes first. The error falls as 1 / spp, so a target's share is what is wanted over what is there.
double share_done(const RenderOptions& o, const RenderState& state, const Progress& p) {
  double share = 0;
  if (o.seconds > 0) share = std::max(share, state.stats.seconds / o.seconds);
  if (o.cpu_seconds > 0) share = std::max(share, state.stats.cpu_seconds / o.cpu_seconds);
  if (o.noise > 0 && p.error_spp > 0)
    share = std::max(share, o.noise / p.error.relmse * spp_of(state.film) / p.error_spp);
  if (const uint32_t most = most_passes(o); most > 0) share = std::max(share, spp_of(state.film) / most);
  return std::clamp(share, 0.0, 1.0);
}

void estimate(Progress& p, const RenderState& state) {
  const double begin = wall_seconds();
  p.error = estimate_error(state.film);
  p.error_spp = spp_of(state.film);
  p.error_next = state.stats.seconds + std::max(1.0, 20 * (wall_seconds() - begin));
}

void print(const Progress& progress, double share, const RenderState& state, bool last) {
  const double elapsed = state.stats.seconds;
  constexpr int width = 24;
  const int full = int(share * width);
  std::string line = fmt::format("[{:#<{}}{:.<{}}] {:5.1f} spp  {} elapsed", "", full, "", width - full,
                                 spp_of(state.film), clock_text(elapsed));
  if (!last && share > 0) line += fmt::format("  {} left", clock_text(elapsed * (1 - share) / share));
  if (const ErrorEstimate& e = progress.error; e.relmse < infinity)  // a single firefly may be most of the second
    line += fmt::format("  relMSE ~ {:.3g} ({:.3g} of all)", e.relmse_trimmed, e.relmse);
  put_line(std::move(line), last);
}

// Characters in a row of the terminal; 0 if it does not say.
size_t columns() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

// A line that goes on in a second row could not be taken back.
void cut_to(std::string& line, size_t most) {
  const auto goes_on = [](char c) { return (c & 0xc0) == 0x80; };  // of UTF-8
  size_t characters = 0;
  for (size_t i = 0; i < line.size(); ++i)
    if (!goes_on(line[i]) && ++characters > most) return line.resize(i);
}

}  // namespace

void put_line(std::string line, bool last) {
  const bool terminal = isatty(STDERR_FILENO);
  if (const size_t row = terminal && !last ? columns() : 0; row > 1) cut_to(line, row - 1);
  std::fprintf(stderr, terminal ? (last ? "\r%s\033[K\n" : "\r%s\033[K") : "%s\n", line.c_str());
  std::fflush(stderr);
}

void clear_line() {
  if (isatty(STDERR_FILENO)) std::fputs("\r\033[K", stderr);
}

std::string clock_text(double s) {
  if (s < 100) return fmt::format("{:.1f} s", s);
  if (s < 6000) return fmt::format("{}:{:02}", int(s) / 60, int(s) % 60);
  constexpr double most = 3.6e6;
  if (!(s < most)) return "over a thousand hours";
  return fmt::format("{}:{:02}:{:02}", int(s) / 3600, int(s) / 60 % 60, int(s) % 60);
}

Progress make_progress(bool quiet) {
  Progress p;
  p.shown = !quiet;
  p.terminal = isatty(STDERR_FILENO);
  return p;
}

void show(Progress& p, const RenderOptions& options, const RenderState& state) {
  const double now = state.stats.seconds;
  if (!p.shown || (p.last >= 0 && now - p.last < (p.terminal ? 0.25 : 10))) return;
  if (p.last < 0 && !p.terminal) {  // in a log, nothing before the first ten seconds
    p.last = 0;
    return;
  }
  if (now >= p.error_next) estimate(p, state);
  p.last = now;
  print(p, share_done(options, state, p), state, false);
}

void finish(Progress& p, const RenderOptions& options, const RenderState& state, bool whole) {
  if (!p.shown) return;
  estimate(p, state);
  print(p, whole ? 1 : share_done(options, state, p), state, true);
}

}  // namespace ajar
