// Frames to film, by ffmpeg.

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>

#include "ajar/core/error.h"
#include "frames.h"

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

// Its exit code; -1 where it did not come to one.
int run(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& a : arguments) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  pid_t child = 0;
  if (posix_spawn(&child, program.c_str(), nullptr, nullptr, argv.data(), environ) != 0) return -1;
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

void require_ffmpeg() {
  if (find_program("ffmpeg").empty())
    throw Error("--video: ffmpeg is not installed (Debian: apt-get install ffmpeg); install it, or leave --video out");
}

void make_video(const FramePattern& png, const FrameRange& frames, double fps, const std::string& out) {
  require_ffmpeg();
  // The name goes on where ffmpeg reads the kind of film from: written aside and renamed, as all files are.
  const fs::path aside = fs::path(out).replace_extension(".part" + fs::path(out).extension().string());
  const std::string names = fmt::format("{}%0{}d{}", png.before, std::max(png.digits, 1), png.after);
  const int status =
      run(find_program("ffmpeg"),
          {"-y", "-nostdin", "-loglevel", "error", "-framerate", fmt::format("{:g}", fps), "-start_number",
           fmt::format("{}", frames.first), "-i", names, "-frames:v", fmt::format("{}", frames.last - frames.first + 1),
           "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", aside.string()});
  std::error_code error;
  if (status == 0) fs::rename(aside, out, error);
  if (status == 0 && !error) return;
  fs::remove(aside, error);
  throw Error(fmt::format("--video {}: ffmpeg failed; the frames are there as {}", out, names));
}

}  // namespace ajar
