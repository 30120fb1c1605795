#include "mtl.h"

#include <algorithm>
#include <cmath>

#include "cursor.h"
#include "node.h"

namespace ajar {
namespace {

// What is no part of a path tracer's materials, or no more than a hint.
constexpr const char* harmless[] = {"Ka", "map_Ka", "Km", "sharpness", "map_aat"};

// One number to n of them, finite as floats.
int numbers(Cursor& in, std::string_view keyword, double* out, int n) {
  const int count = in.numbers(out, n);
  if (count == 0) in.fail(fmt::format("{} needs a number", keyword));
  for (int i = 0; i < count; ++i)
    if (!std::isfinite(float(out[i]))) in.fail(fmt::format("a number of {} is not finite", keyword));
  return count;
}

double number(Cursor& in, std::string_view keyword, double low, double high) {
  double x;
  numbers(in, keyword, &x, 1);
  if (!(x >= low && x <= high)) in.fail(fmt::format("{} {} should be from {} to {}", keyword, x, low, high));
  return x;
}

// False where the colour is a spectrum's file or CIE XYZ.
bool read_colour(Cursor& in, std::string_view keyword, Rgb& out) {
  in.skip_blanks();
  const std::string first = in.token();
  if (first == "spectral" || first == "xyz") return false;
  double c[3];
  const int count = numbers(in, keyword, c, 3);
  if (count == 2) in.fail(fmt::format("{} has two numbers; it needs one or three", keyword));
  out = count == 1 ? Rgb(float(c[0])) : Rgb(c[0], c[1], c[2]);
  if (std::min({out.x, out.y, out.z}) < 0) in.fail(fmt::format("a number of {} is negative", keyword));
  return true;
}

Channel channel_of(const std::string& letter) {
  if (letter == "r") return Channel::red;
  if (letter == "g") return Channel::green;
  if (letter == "b") return Channel::blue;
  return letter == "m" ? Channel::alpha : Channel::color;
}

// u, or u v, or u v w: as many numbers as there are, for the file's name comes next.
void read_uv(Cursor& in, Vec2& out) {
  for (int i = 0; i < 3 && !in.at_end(); ++i) {
    Cursor ahead = in;
    double x;
    ahead.p = read_number(in.p, in.end, x);
    if (ahead.p == in.p || !ahead.ends_token()) return;
    in.p = ahead.p;
    if (!std::isfinite(float(x))) in.fail("a number of a map is not finite");
    if (i < 2) out[i] = float(x);
  }
}

std::string take_token(Cursor& in) {
  in.skip_blanks();
  return std::string(in.word());
}

// One of the options before a file's name; those that are not used are passed over with what belongs to them.
void read_option(Cursor& in, const std::string& option, MtlMap& map) {
  double passed[2];
  Vec2 turbulence;
  if (option == "-s") {
    read_uv(in, map.scale);
  } else if (option == "-o") {
    read_uv(in, map.offset);
  } else if (option == "-t") {
    read_uv(in, turbulence);
  } else if (option == "-bm") {
    map.height = float(number(in, option, -1e6, 1e6));
  } else if (option == "-mm") {
    numbers(in, option, passed, 2);
  } else if (option == "-boost" || option == "-texres") {
    numbers(in, option, passed, 1);
  } else {  // -blendu on, -type cube_top
    const std::string word = take_token(in);
    if (option == "-clamp") map.clamp = word == "on";
    if (option == "-imfchan") map.channel = channel_of(word);
  }
}

bool is_option(const std::string& word) {
  static constexpr const char* options[] = {"-s",  "-o",     "-t",      "-bm",     "-mm",      "-boost", "-texres",
                                            "-cc", "-clamp", "-blendu", "-blendv", "-imfchan", "-type"};
  return std::find(std::begin(options), std::end(options), word) != std::end(options);
}

MtlMap read_map(Cursor& in, std::string_view keyword) {
  MtlMap map;
  for (in.skip_blanks(); is_option(in.token()); in.skip_blanks()) {
    const std::string option = take_token(in);
    read_option(in, option, map);
  }
  map.file = read_name(in);
  if (map.file.empty()) in.fail(fmt::format("{} needs a file", keyword));
  return map;
}

// d, with -halo before its number or not.
float read_opacity(Cursor& in, std::string_view keyword) {
  in.skip_blanks();
  if (in.token() == "-halo") take_token(in);
  return float(number(in, keyword, 0, 1));
}

// Exporters write them with what changes nothing: no light of its own, a filter without a colour.
bool changes_nothing(Cursor& in, std::string_view keyword) {
  Rgb c;
  if (!read_colour(in, keyword, c)) return false;
  return keyword == "Ke" ? is_black(c) : c.x == c.y && c.y == c.z;
}

// Whether the statement is used, or says nothing.
bool read_statement(Cursor& in, std::string_view keyword, MtlMaterial& m) {
  if (keyword == "Kd") return read_colour(in, keyword, m.diffuse);
  if (keyword == "Ks") return m.has_specular = read_colour(in, keyword, m.specular);
  if (keyword == "Ke" || keyword == "Tf") return changes_nothing(in, keyword);
  if (keyword == "Tr") return number(in, keyword, 0, 1) == 0;  // to some exporters 1 is opaque, to others clear
  if (keyword == "Ns")
    m.exponent = float(std::max(number(in, keyword, -1e6, 1e6), 0.0));  // Blender has written -1.96 for none
  else if (keyword == "Ni")
    m.ior = float(number(in, keyword, 0, 1e3));
  else if (keyword == "illum")
    m.illum = int(number(in, keyword, 0, 1e3));
  else if (keyword == "d")
    m.opacity = read_opacity(in, keyword);
  else if (keyword == "map_Kd")
    m.map_diffuse = read_map(in, keyword);
  else if (keyword == "map_Ks")
    m.map_specular = read_map(in, keyword);
  else if (keyword == "map_d")
    m.map_opacity = read_map(in, keyword);
  else if (keyword == "bump" || keyword == "map_bump" || keyword == "map_Bump")
    m.map_bump = read_map(in, keyword);
  else
    return std::find(std::begin(harmless), std::end(harmless), keyword) != std::end(harmless);
  return true;
}

}  // namespace

MtlFile parse_mtl(std::string_view text, const std::string& name) {
  MtlFile out;
  text = without_mark(text);
  Cursor in{text.data(), text.data() + text.size(), name};
  for (; in.p != in.end; in.skip_line()) {
    if (in.at_end()) continue;
    const std::string_view keyword = in.word();
    if (keyword == "newmtl") {
      const std::string& added = out.materials.emplace_back().name = read_name(in);
      out.by_name[added] = uint32_t(out.materials.size() - 1);
      continue;
    }
    if (out.materials.empty() || !read_statement(in, keyword, out.materials.back()))
      out.unread.emplace(keyword.substr(0, 40));
  }
  return out;
}

}  // namespace ajar
