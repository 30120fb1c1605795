// The picture of error against time: lines are where the axes say, and a picture without lines is none.

#include "ajar/report/curves.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

namespace ajar {
namespace {

using nlohmann::json;

/// Error `factor` at 1 s, a tenth of it at 10 s, on a line in between.
json run(double factor) {
  json samples = json::array();
  for (const double t : {1.0, 2.0, 10.0})
    samples.push_back({{"cpu_seconds", t}, {"seconds", t / 2}, {"spp", 8 * t}, {"relmse_trimmed", factor / t}});
  return {{"samples", samples}};
}

json results(const std::vector<double>& factors) {
  json method = {{"name", "a<b"}, {"runs", json::array()}};
  for (const double f : factors) method["runs"].push_back(run(f));
  return {{"title", "x & y"},
          {"budget", {{"cpu_seconds", 10}}},
          {"scenes", {{{"name", "room"}, {"width", 4}, {"height", 3}, {"methods", {method}}}}}};
}

/// The number that stands before `label` of an axis; 0: x, 1: y.
double tick(const std::string& svg, int axis, const std::string& label) {
  const std::regex text("<text x='([0-9.]+)' y='([0-9.]+)' class='tick' text-anchor='" +
                        std::string(axis == 0 ? "middle" : "end") + "'>" + label + "</text>");
  std::smatch found;
  EXPECT_TRUE(std::regex_search(svg, found, text)) << label;
  return found.empty() ? NAN : axis == 0 ? std::stod(found[1]) : std::stod(found[2]) - 4;
}

std::vector<double> points(const std::string& svg) {
  std::smatch line;
  EXPECT_TRUE(std::regex_search(svg, line, std::regex("<polyline points='([^']*)'")));
  std::vector<double> out;
  std::string text = line.empty() ? "" : line[1].str();
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream in(text);
  for (double v; in >> v;) out.push_back(v);
  return out;
}

TEST(Curves, MedianIsWhereTheAxesSay) {
  const std::string svg = curves_svg(results({0.8, 1, 1.5}));
  const std::vector<double> at = points(svg);
  ASSERT_EQ(at.size(), 6U) << svg;
  const double places[] = {tick(svg, 0, "1"),   tick(svg, 1, "1"),  tick(svg, 0, "2"),
                           tick(svg, 1, "0.5"), tick(svg, 0, "10"), tick(svg, 1, "0.1")};
  for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(at[i], places[i], 0.11) << i;
  EXPECT_LT(at[0], at[4]);
  EXPECT_LT(at[1], at[5]) << "small errors are below";
}

TEST(Curves, BandHoldsTheSpreadOfTheSeeds) {
  EXPECT_NE(curves_svg(results({0.5, 1})).find("<polygon"), std::string::npos);
  EXPECT_EQ(curves_svg(results({1})).find("<polygon"), std::string::npos) << "one seed has none";
}

TEST(Curves, EndAtTheEndOfABudgetInSamples) {
  json by_samples = results({1, 1, 1});
  by_samples["budget"] = {{"spp", 80}};
  auto& runs = by_samples["scenes"][0]["methods"][0]["runs"];
  for (json& sample : runs[0]["samples"]) sample["cpu_seconds"] = sample["cpu_seconds"].get<double>() / 2;  // faster
  const std::string svg = curves_svg(by_samples);
  const std::vector<double> at = points(svg);
  ASSERT_EQ(at.size(), 6U) << svg;
  EXPECT_NEAR(at[5], tick(svg, 1, "0.1"), 0.11) << "the error of all seeds at the end";
  EXPECT_NEAR(at[4] - at[2], (at[2] - at[0]) * std::log(5) / std::log(2), 0.2) << "8, 16, 80";
  EXPECT_NE(svg.find(">samples per pixel</text>"), std::string::npos);
}

size_t count(const std::string& text, const std::string& part) {
  size_t n = 0;
  for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(Curves, AxesHaveTwoLabelsAtLeastHoweverNarrow) {
  json narrow = results({1});
  json& samples = narrow["scenes"][0]["methods"][0]["runs"][0]["samples"];
  samples.erase(2);
  for (const double ratio : {1.0, 1.05, 1.4, 2.0, 4.0, 9.0, 30.0, 80.0, 1000.0})
    for (double from = 1e-3; from < 1.1e-2; from *= 1.07) {
      for (const size_t i : {0, 1})
        samples[i]["cpu_seconds"] = samples[1 - i]["relmse_trimmed"] = i == 0 ? from : from * ratio;
      const std::string svg = curves_svg(narrow);
      const size_t x = count(svg, "class='tick' text-anchor='middle'>") - 1, y = count(svg, "text-anchor='end'>");
      EXPECT_TRUE(x >= 2 && x <= 7 && y >= 2 && y <= 7) << x << ", " << y << "\n" << svg;
    }
}

struct Text {
  double x, y, size;
  std::string words;
};

/// Those that begin at the left, as all long ones do.
std::vector<Text> texts(const std::string& svg) {
  std::vector<Text> out;
  const std::regex text("<text x='([0-9.]+)' y='([0-9.]+)'([^>]*)>([^<]*)</text>");
  for (std::sregex_iterator at(svg.begin(), svg.end(), text), end; at != end; ++at) {
    const std::string kind = (*at)[3];
    if (kind.find("text-anchor") != kind.npos) continue;
    const double size = kind.find("'14'") != kind.npos ? 14 : kind.find("tick") != kind.npos ? 11 : 12;
    out.push_back({std::stod((*at)[1]), std::stod((*at)[2]), size, (*at)[4]});
  }
  return out;
}

double width_of(const std::string& svg) { return std::stod(svg.substr(svg.find(" width='") + 8)); }

/// By letters of the usual width.
void expect_all_inside(const std::string& svg) {
  for (const Text& t : texts(svg)) EXPECT_LE(t.x + 0.6 * t.size * double(t.words.size()), width_of(svg)) << t.words;
}

TEST(Curves, NothingIsWiderThanThePicture) {
  json wide = results({1});
  EXPECT_EQ(width_of(curves_svg(wide)), 420);
  expect_all_inside(curves_svg(wide));
  std::string title;
  for (int i = 0; i < 40; ++i) title += fmt::format("word {} ", i);
  wide["title"] = title + std::string(150, 'x');
  const std::string svg = curves_svg(wide);
  EXPECT_EQ(width_of(svg), 420) << "long titles are wrapped";
  expect_all_inside(svg);
  std::string joined;
  for (const Text& t : texts(svg))
    if (t.size == 14) joined += t.words + (t.words[0] == 'x' ? "" : " ");
  EXPECT_EQ(joined, title + std::string(150, 'x')) << "and whole";
  wide["scenes"][0]["methods"][0]["name"] = std::string(100, 'm');
  expect_all_inside(curves_svg(wide));
  EXPECT_NE(curves_svg(wide).find(">" + std::string(100, 'm') + "</text>"), std::string::npos);
  wide["scenes"][0]["name"] = std::string(250, 'n');
  expect_all_inside(curves_svg(wide));
}

TEST(Curves, NinthMethodIsDashed) {
  json many = results({1});
  json& methods = many["scenes"][0]["methods"];
  const json method = methods[0];
  methods[0]["runs"] = json::array();  // has no line, and its colour all the same
  const auto styles = [&] {
    std::vector<std::string> out;
    const std::string svg = curves_svg(many);
    const std::regex line("<polyline points='[^']*'([^>]*)/>");
    for (std::sregex_iterator at(svg.begin(), svg.end(), line), end; at != end; ++at) out.push_back((*at)[1]);
    return out;
  };
  for (int i = 1; i < 8; ++i) {
    methods.push_back(method);
    methods.back()["name"] = fmt::format("method {}", i);
  }
  EXPECT_EQ(styles().size(), 7U) << "no lines before names that colours tell apart";
  EXPECT_EQ(styles()[0], " stroke='#d55e00'") << "the second of the page's colours";
  methods.push_back(method);
  methods.back()["name"] = "method 8";
  const std::vector<std::string> with_dashes = styles();
  ASSERT_EQ(with_dashes.size(), 16U) << "a piece of its line before each name";
  EXPECT_EQ(with_dashes[7], " stroke='#0072b2' stroke-dasharray='8 4'");
  EXPECT_EQ(std::count(with_dashes.begin(), with_dashes.end(), with_dashes[7]), 2);
  expect_all_inside(curves_svg(many));
}

TEST(Curves, ManyNamesAreBelowTheHead) {
  json many = results({1});
  json& methods = many["scenes"][0]["methods"];
  const json method = methods[0];
  for (int i = 1; i < 30; ++i) methods.push_back(method), methods.back()["name"] = fmt::format("method {}", i);
  size_t names = 0;
  double head = 0;
  for (const Text& t : texts(curves_svg(many))) {
    if (t.words.starts_with("room")) head = t.y;
    if (!t.words.starts_with("method")) continue;
    EXPECT_GT(t.y, head) << t.words;
    ++names;
  }
  EXPECT_EQ(names, 29U);
}

TEST(Curves, NamesCannotBreakOut) {
  const std::string svg = curves_svg(results({1}));
  EXPECT_NE(svg.find(">a&lt;b</text>"), std::string::npos);
  EXPECT_NE(svg.find("x &amp; y"), std::string::npos);
  EXPECT_EQ(svg.find("a<b"), std::string::npos);
}

TEST(Curves, WhatHasNoSampleIsLeftOut) {
  EXPECT_EQ(curves_svg(results({})), "");
  json dark = results({1});
  dark["scenes"].push_back({{"name", "shut"}, {"methods", json::array()}});
  dark["scenes"][0]["methods"][0]["runs"].push_back(run(0));  // no logarithm
  EXPECT_EQ(curves_svg(dark), curves_svg(results({1})));
}

TEST(Curves, OneSampleIsADot) {
  json one = results({1});
  json& samples = one["scenes"][0]["methods"][0]["runs"][0]["samples"];
  samples = {samples[0]};
  const std::string svg = curves_svg(one);
  EXPECT_NE(svg.find("<circle"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

}  // namespace
}  // namespace ajar
