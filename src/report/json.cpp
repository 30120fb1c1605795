#include "ajar/report/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <vector>

#include "ajar/core/error.h"

namespace ajar {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string text_of(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string short_text_of(const Json& value) {
  const std::string whole = text_of(value, -1);
  return whole.size() <= 40 ? whole : whole.substr(0, 37) + "...";
}

Json read_json(const std::filesystem::path& path, const char* cure) {
  std::ifstream in(path, std::ios::binary);
  std::error_code none_such;
  if (!in || std::filesystem::is_directory(path, none_such))
    throw Error(fmt::format("{}: cannot be read; is it a file, and there?", path.string()));
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::vector<std::set<std::string>> keys;
  const auto watch = [&](int, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second)
      throw Error(fmt::format("{}: key {} comes twice in one object; keep one", path.string(), short_text_of(parsed)));
    return true;
  };
  try {
    return Json::parse(bytes, watch);
  } catch (const Json::parse_error& error) {
    const std::string before = bytes.substr(0, std::min(error.byte > 0 ? error.byte - 1 : 0, bytes.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const size_t column = before.size() - (before.rfind('\n') == std::string::npos ? 0 : before.rfind('\n') + 1) + 1;
    throw Error(fmt::format("{}: line {}, column {}: not JSON here; {}", path.string(), line, column, cure));
  } catch (const Json::exception&) {
    throw Error(fmt::format("{}: holds a number that is too large; write one below 1e308", path.string()));
  }
}

}  // namespace ajar
