#include "timeline.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "ajar/core/error.h"
#include "ajar/report/json.h"
#include "arguments.h"

namespace ajar {
namespace {

constexpr int most_frames = 1000000;

// Numbers divided by blanks or commas; nothing if one is none.
std::optional<std::vector<double>> to_numbers(std::string_view text) {
  std::vector<double> out;
  constexpr std::string_view between = ", \t";
  for (size_t at; (at = text.find_first_not_of(between)) != text.npos;) {
    text.remove_prefix(at);
    const size_t n = std::min(text.find_first_of(between), text.size());
    double x = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + n, x);
    if (error != std::errc() || end != text.data() + n || !std::isfinite(x)) return {};
    out.push_back(x);
    text.remove_prefix(n);
  }
  if (out.empty()) return {};
  return out;
}

// A whole number at the start of the text, which it is taken from; -1 if there is none.
int take_integer(std::string_view& text) {
  int n = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
  if (error != std::errc() || text.starts_with('-')) return -1;
  text.remove_prefix(size_t(end - text.data()));
  return n;
}

bool take(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

// count: what the keyframes say, 0 for nothing.
FrameRange parse_frames(const std::string& written, int count) {
  const auto wrong = [&](const std::string& why) { return Error(fmt::format("--frames {}: {}", written, why)); };
  const std::string how = "write 48 for all of 48, or 10-20/48 for some of them, counted from 0";
  if (written.empty() && count == 0) throw Error("--frames is missing: " + how);
  if (written.empty()) return {0, count - 1, count};
  std::string_view rest = written;
  FrameRange r;
  r.first = r.last = take_integer(rest);
  const bool is_range = take(rest, '-');
  if (is_range) r.last = take_integer(rest);
  const bool has_count = take(rest, '/');
  const int keyed = count;
  if (has_count) count = take_integer(rest);
  if (!rest.empty() || r.first < 0 || r.last < 0 || count < 0) throw wrong("not a range of frames; " + how);
  if (!is_range && !has_count) {  // a number of frames
    if (count > 0 && count != r.first)
      throw wrong(
          fmt::format("the keyframes say {}; leave it out{}", count,
                      r.first < count ? fmt::format(", or write {}/{} for that frame alone", r.first, count) : ""));
    count = r.first, r.first = 0, r.last = count - 1;
  }
  if (keyed > 0 && count != keyed) throw wrong(fmt::format("the keyframes say {}; write that, or leave it out", keyed));
  if (is_range && count == 0)
    throw wrong(fmt::format("how many are there in all? Write {}-{}/48 for a part of 48", r.first, r.last));
  if (count < 1 || count > most_frames) throw wrong(fmt::format("an animation has from 1 to {} frames", most_frames));
  if (r.first > r.last) throw wrong("the first frame comes after the last");
  if (r.last >= count) throw wrong(fmt::format("{} frames are numbered from 0 to {}", count, count - 1));
  r.count = count;
  return r;
}

// "a..b..c" at even distances; nothing where the value is no sweep. Paths have dots, too: ../models is none.
std::optional<Track> parse_sweep(const std::string& written, std::string value, int count) {
  Track track;
  const auto wrong = [&](const std::string& why) {
    return Error(fmt::format("{}: {}; write 5..60, or 5..60:smooth", written, why));
  };
  if (value.find("..") == value.npos) return {};
  const size_t colon = std::min(value.rfind(':'), value.size());
  const std::string how = value.substr(colon);
  value.resize(colon);
  bool any = false, all = true;
  for (size_t from = 0; from <= value.size();) {
    const size_t to = std::min(value.find("..", from), value.size());
    const auto numbers = to_numbers(std::string_view(value).substr(from, to - from));
    if (numbers) track.keys.push_back({0, *numbers});
    any = any || numbers, all = all && numbers;
    from = to + 2;
  }
  if (!any) return {};
  if (!how.empty() && how != ":smooth" && how != ":linear")
    throw wrong(fmt::format("\"{}\" is neither linear nor smooth", how.substr(1)));
  track.smooth = how == ":smooth";
  if (!all) throw wrong("sweeps go from number to number");
  if (value.find("...") != value.npos) throw wrong("three dots may be two and a point, .5; write two, and 0.5");
  for (size_t i = 0; i < track.keys.size(); ++i) {
    if (track.keys[i].values.size() != track.keys[0].values.size())
      throw wrong("all its values need the same number of numbers");
    track.keys[i].frame = double(count - 1) * double(i) / double(track.keys.size() - 1);
  }
  if (count == 1) track.keys.resize(1);
  return track;
}

using Json = nlohmann::ordered_json;

Track::Key parse_key(const Json& key, const std::string& where) {
  const auto wrong = [&] {
    return Error(where + ": a key is [FRAME, VALUE], the value a number or a list of numbers");
  };
  if (!key.is_array() || key.size() != 2 || !key[0].is_number()) throw wrong();
  Track::Key out{key[0].get<double>(), {}};
  const Json list = key[1].is_array() ? key[1] : Json::array({key[1]});
  for (const Json& x : list) {
    if (!x.is_number()) throw wrong();
    out.values.push_back(x.get<double>());
  }
  if (out.values.empty()) throw wrong();
  return out;
}

Track parse_track(const Json& json, const std::string& where) {
  Track track;
  const Json* keys = &json;
  if (json.is_object()) {
    for (const auto& [name, value] : json.items()) {
      if (name != "keys" && name != "smooth")
        throw Error(fmt::format("{}: \"{}\" is unknown; known are keys, smooth", where, name));
      if (name == "smooth" && !value.is_boolean()) throw Error(where + ": smooth is true or false");
    }
    track.smooth = json.value("smooth", false);
    if (!json.contains("keys")) throw Error(where + ": needs \"keys\": [[FRAME, VALUE], ...]");
    keys = &json["keys"];
  }
  if (!keys->is_array() || keys->empty()) throw Error(where + ": needs a list of keys [[FRAME, VALUE], ...]");
  for (const Json& key : *keys) track.keys.push_back(parse_key(key, where));
  for (size_t i = 1; i < track.keys.size(); ++i) {
    if (!(track.keys[i - 1].frame < track.keys[i].frame))
      throw Error(where + ": keys should be in the order of their frames");
    if (track.keys[i].values.size() != track.keys[0].values.size())
      throw Error(where + ": all its keys need the same number of values");
  }
  return track;
}

struct Keyframes {
  int frames = 0;
  std::map<std::string, Track> tracks;
};

Keyframes read_keyframes(const std::string& path) {
  const Json json = read_json(path);
  const std::string how = R"(write {"frames": 48, "parameters": {"door": [[0, 2], [47, 60]]}})";
  if (!json.is_object()) throw Error(fmt::format("{}: {}", path, how));
  Keyframes out;
  for (const auto& [name, value] : json.items()) {
    if (name == "frames") {
      if (!value.is_number_integer() || value < 1 || value > most_frames)
        throw Error(fmt::format("{}: frames should be a whole number from 1 to {}", path, most_frames));
      out.frames = value;
    } else if (name == "parameters" && value.is_object()) {
      for (const auto& [parameter, track] : value.items())
        out.tracks[parameter] = parse_track(track, fmt::format("{}: parameter \"{}\"", path, parameter)),
        out.tracks[parameter].file = path;
    } else {
      throw Error(fmt::format("{}: \"{}\" is unknown, or of the wrong kind; {}", path, name, how));
    }
  }
  return out;
}

// Such a key shapes what is before it, but no image shows it: of every parameter the first is told.
void note_unreached(const std::string& path, Timeline& t) {
  const int last = t.frames.count - 1;
  for (const auto& [parameter, track] : t.tracks) {
    const auto key = std::find_if(track.keys.begin(), track.keys.end(),
                                  [&](const Track::Key& k) { return k.frame < 0 || k.frame > last; });
    if (key != track.keys.end())
      t.notes.push_back(fmt::format("{}: parameter \"{}\": no frame reaches its key at {:g}; they go from 0 to {}",
                                    path, parameter, key->frame, last));
  }
}

// Slope of a smooth track at a key: zero where it turns, and at both ends; else the harmonic mean of the slopes on both
// sides, with which nothing overshoots (Fritsch and Butland 1984).
double slope_at(const Track& track, size_t key, size_t value) {
  if (key == 0 || key + 1 == track.keys.size()) return 0;
  const auto slope = [&](size_t i) {
    const Track::Key &a = track.keys[i], &b = track.keys[i + 1];
    return (b.values[value] - a.values[value]) / (b.frame - a.frame);
  };
  const double before = slope(key - 1), after = slope(key);
  return before * after > 0 ? 2 * before * after / (before + after) : 0;
}

int sign_of(double x) { return (x > 0) - (x < 0); }

bool is_marked(const Track& track, int frame) {
  for (const Track::Key& key : track.keys)
    if (std::abs(key.frame - frame) < 1) return true;
  const std::vector<double> before = values_at(track, frame - 1), here = values_at(track, frame),
                            after = values_at(track, frame + 1);
  for (size_t k = 0; k < here.size(); ++k)
    if (sign_of(here[k]) != sign_of(before[k]) || sign_of(here[k]) != sign_of(after[k])) return true;
  return false;
}

}  // namespace

bool is_marked(const Timeline& timeline, int frame) {
  return std::any_of(timeline.tracks.begin(), timeline.tracks.end(),
                     [&](const auto& named) { return is_marked(named.second, frame); });
}

Timeline make_timeline(const std::string& frames, const std::vector<std::string>& defines, const std::string& keyframes,
                       const std::string& at) {
  Timeline t;
  Keyframes keys;
  if (!keyframes.empty()) keys = read_keyframes(keyframes);
  t.frames = parse_frames(frames, keys.frames);
  t.tracks = keys.tracks;
  note_unreached(keyframes, t);
  for (const std::string& d : defines) {
    const auto [name, value] = parse_define(d, "-D name=FROM..TO or -D name=value");
    if (t.tracks.contains(name) || t.constant.contains(name))
      throw Error(fmt::format("-D {}: {} is given twice; leave one of them out", d, name));
    if (const auto sweep = parse_sweep("-D " + d, value, t.frames.count))
      t.tracks[name] = *sweep;
    else
      t.constant[name] = value;
  }
  if (at.empty()) return t;
  const size_t dots = std::min(at.find(".."), at.size());
  const auto from = to_numbers(std::string_view(at).substr(0, dots));
  const auto to = to_numbers(std::string_view(at).substr(std::min(dots + 2, at.size())));
  if (at.find("...") != at.npos || !from || !to || from->size() != 1 || to->size() != 1)
    throw Error(
        fmt::format("--at {}: write FROM..TO, the scene's time at the first and the last frame, such as 0..2", at));
  t.has_time = true, t.first_time = from->front(), t.last_time = to->front();
  return t;
}

std::vector<double> values_at(const Track& track, double frame) {
  if (frame <= track.keys.front().frame) return track.keys.front().values;
  if (frame >= track.keys.back().frame) return track.keys.back().values;
  size_t i = 0;
  while (track.keys[i + 1].frame <= frame) ++i;
  const Track::Key &a = track.keys[i], &b = track.keys[i + 1];
  const double width = b.frame - a.frame, u = (frame - a.frame) / width;
  std::vector<double> out;
  for (size_t k = 0; k < a.values.size(); ++k) {
    const double change = b.values[k] - a.values[k];
    const double from = track.smooth ? slope_at(track, i, k) * width : change;
    const double to = track.smooth ? slope_at(track, i + 1, k) * width : change;
    // Cubic with these slopes at its ends (Hermite); a straight line where all agree.
    const double value = a.values[k] + u * (from + u * (3 * change - 2 * from - to + u * (from + to - 2 * change)));
    // What rounding leaves of 0 would be no whole number.
    out.push_back(std::abs(value) < 1e-12 * std::abs(change) ? 0 : value);
  }
  return out;
}

std::map<std::string, std::string> parameters_at(const Timeline& timeline, int frame) {
  std::map<std::string, std::string> out = timeline.constant;
  for (const auto& [name, track] : timeline.tracks) {
    const std::vector<double> values = values_at(track, frame);
    out[name] = fmt::format("{:.9g}", fmt::join(values, ", "));
  }
  return out;
}

}  // namespace ajar
