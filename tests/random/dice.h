// Enters: a seed.
// Leaves: choices, the same on every machine, and what was chosen, by name.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <initializer_list>
#include <string>

namespace ajar::random {

class Dice {
 public:
  explicit Dice(uint64_t seed) : state_(seed) {}

  double between(double a, double b) { return a + (b - a) * double(next() >> 11) * 0x1p-53; }
  bool chance(double p) { return between(0, 1) < p; }
  int below(int n) { return int(next() % uint64_t(n)); }
  template <typename T>
  T any(std::initializer_list<T> of) {
    return of.begin()[below(int(of.size()))];
  }
  /// The same, and notes it.
  std::string one(std::initializer_list<const char*> of) {
    const std::string chosen = any(of);
    note(chosen);
    return chosen;
  }
  void note(const std::string& what) { noted_ += (noted_.empty() ? "" : " ") + what; }
  const std::string& noted() const { return noted_; }

 private:
  uint64_t next() {  // SplitMix64 (Steele, Lea and Flood 2014)
    uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  uint64_t state_;
  std::string noted_;
};

// Parts of Mitsuba's XML. Lists in braces are made from left to right, as the operands of + need not be: so what throws
// dice stands in one.
using Parts = std::initializer_list<std::string>;
inline std::string joined(Parts parts) {
  std::string all;
  for (const std::string& part : parts) all += part;
  return all;
}
/// <element type="..." HEAD>INSIDE</element>
inline std::string element(const char* name, const std::string& type, Parts inside, const std::string& head = "") {
  return fmt::format(R"(<{0} type="{1}"{2}>{3}</{0}>)", name, type, head, joined(inside)) + "\n";
}
inline std::string number(const char* name, double value) {
  return fmt::format(R"(<float name="{}" value="{:.4g}"/>)", name, value);
}
inline std::string text(const char* name, const std::string& value) {
  return fmt::format(R"(<string name="{}" value="{}"/>)", name, value);
}
inline std::string yes(const char* name) { return fmt::format(R"(<boolean name="{}" value="true"/>)", name); }
inline std::string colour(Dice& dice, const char* name, double a, double b) {
  const double red = dice.between(a, b), green = dice.between(a, b), blue = dice.between(a, b);
  return fmt::format(R"(<rgb name="{}" value="{:.3f}, {:.3f}, {:.3f}"/>)", name, red, green, blue);
}

}  // namespace ajar::random
