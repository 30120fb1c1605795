// Frames to film, by ffmpeg.

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "arguments.h"
#include "frames.h"
#include "stop.h"

extern char** environ;

namespace ajar {
namespace {

namespace fs = std::filesystem;

// As the shell would find it; empty if it is not there.
std::string find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::string_view rest = path ? path : "/usr/bin:/bin";
  while (!rest.empty()) {
    const size_t n = std::min(rest.find(':'), rest.size());
    const fs::path file = fs::path(rest.substr(0, n)) / name;
    if (access(file.c_str(), X_OK) == 0 && fs::is_regular_file(file)) return file.string();
    rest.remove_prefix(std::min(n + 1, rest.size()));
  }
  return {};
}

// What this program ignores (guard_streams) another one need not.
pid_t start(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  sigset_t usual;
  sigemptyset(&usual);
  sigaddset(&usual, SIGPIPE), sigaddset(&usual, SIGXFSZ);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  pid_t child = -1;
  const bool started = posix_spawn(&child, program.c_str(), nullptr, &attributes, argv.data(), environ) == 0;
  posix_spawnattr_destroy(&attributes);
  return started ? child : -1;
}

// Its exit code; -1 where it did not come to one. It ends early where the user wants an end.
int run(const std::string& program, const std::vector<std::string>& arguments) {
  const pid_t child = start(program, arguments);
  if (child < 0) return -1;
  int status = 0;
  for (bool told = false;;) {
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    if (ended < 0 && errno != EINTR) return -1;
    if (stop_asked() && !told) told = kill(child, SIGTERM) == 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

// The working folder before a name with a place for numbers. There % is ffmpeg's own sign.
std::string absolute_pattern(const std::string& names) {
  std::error_code unknown;
  const std::string all = fs::absolute(names, unknown).string();
  std::string out;
  for (const char c : all.substr(0, all.size() - names.size())) out.append(c == '%' ? 2 : 1, c);
  return out + names;
}

// What MPEG-1 and MPEG-2 can say (ISO/IEC 13818-2, table 6-4).
bool is_mpeg_rate(double fps) {
  constexpr double known[] = {24, 25, 30, 50, 60};
  return std::any_of(std::begin(known), std::end(known),
                     [&](double rate) { return fps == rate || std::abs(fps - rate * 1000 / 1001) < 0.005; });
}

}  // namespace

void check_video(const std::string& out, double fps) {
  static constexpr const char* known[] = {".mp4", ".mov", ".mkv", ".webm", ".gif",  ".avi", ".m4v",
                                          ".mpg", ".ogv", ".wmv", ".flv",  ".mpeg", ".ts"};
  if (std::find(std::begin(known), std::end(known), extension_of(out)) == std::end(known))
    throw Error(fmt::format("--video {}: is no name for a film; write NAME.mp4, or one with {}", out,
                            fmt::join(std::begin(known) + 1, std::end(known), ", ")));
  if ((extension_of(out) == ".mpg" || extension_of(out) == ".mpeg") && !is_mpeg_rate(fps))
    throw Error(fmt::format(
        "--video {}: MPEG has no {:g} frames a second; write --fps 24, 25, 30, 50 or 60, or NAME.mp4", out, fps));
  if (find_program("ffmpeg").empty())
    throw Error("--video: ffmpeg is not installed (Debian: apt-get install ffmpeg); install it, or leave --video out");
}

void make_video(const FramePattern& png, const FrameRange& frames, double fps, const std::string& out) {
  // The name goes on where ffmpeg reads the kind of film from: written aside and renamed, as all files are. Absolute
  // names are taken for no option and no protocol (a:b).
  std::error_code error;
  make_folder_of(out);
  const fs::path target = fs::absolute(target_of(out), error);
  const fs::path aside = fs::path(target).replace_extension(temporary_suffix() + fs::path(out).extension().string());
  const std::string names = fmt::format("{}%0{}d{}", png.before, std::max(png.digits, 1), png.after);
  const int status =
      run(find_program("ffmpeg"), {"-y", "-nostdin", "-loglevel", "error", "-framerate", fmt::format("{:g}", fps),
                                   "-start_number", fmt::format("{}", frames.first), "-i", absolute_pattern(names),
                                   "-frames:v", fmt::format("{}", frames.last - frames.first + 1), "-vf",
                                   "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", aside.string()});
  if (status == 0) fs::rename(aside, target, error);
  if (status == 0 && !error) return;
  fs::remove(aside, error);
  if (stop_asked()) throw Interrupted{fmt::format("interrupted; {} is not made, but all frames are there", out)};
  throw Error(fmt::format("--video {}: ffmpeg failed; the frames are there as {}", out, names));
}

}  // namespace ajar
