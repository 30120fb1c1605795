// Sums of passes, and the estimate of the error, against figures worked out by hand.
#include "ajar/film/film.h"

#include <gtest/gtest.h>

namespace ajar {
namespace {

Film film_of(int width, int height, bool splats = false) {
  Camera camera;
  camera.crop_width = camera.width = width, camera.crop_height = camera.height = height;
  return make_film(camera, make_filter(FilterKind::box), splats);
}

void pass(Film& film, const std::vector<Rgb>& camera, const std::vector<Rgb>& splat = {}, double weight = 1) {
  film.camera = camera;
  if (film.splats) film.splat = splat;
  finish_pass(film, weight);
}

std::vector<Rgb> grey(std::initializer_list<float> values) {
  std::vector<Rgb> out;
  for (const float v : values) out.emplace_back(v);
  return out;
}

TEST(ErrorEstimate, NeedsTwoPassesAndLight) {
  Film film = film_of(2, 1);
  EXPECT_EQ(estimated_error(film), infinity);
  pass(film, grey({1, 1}));
  EXPECT_EQ(estimated_error(film), infinity);
  pass(film, grey({1, 1}));
  EXPECT_EQ(estimated_error(film), 0) << "halves agree";
  Film dark = film_of(2, 1);
  for (int i = 0; i < 8; ++i) pass(dark, grey({0, 0}));
  EXPECT_EQ(estimated_error(dark), infinity) << "nothing seen says nothing";
}

// E1 to E3 of docs/notation.md: the square of half the difference of the halves, over the pixel's mean or, the more its
// passes disagree, over the mean around it, if that is less, but no less than the passes leave no doubt of.
double error(double square, double mean, double variance, double around) {
  const double trust = mean * mean / (mean * mean + 20 * variance), sure = mean - 2 * std::sqrt(variance);
  const double dim = std::max(std::min(mean, around), sure);
  return square * (trust / (mean * mean + 0.01) + (1 - trust) / (dim * dim + 0.01));
}

// Two pixels, each the other's only neighbour. Halves of the left one: 3 and 1; of the right one 0.5 and 0.5.
TEST(ErrorEstimate, IsTheDifferenceOfHalvesOverTheLight) {
  Film film = film_of(2, 1);
  pass(film, grey({3, 0.5f}));
  pass(film, grey({1, 0.5f}));
  // The mean is 2 with variance 1, so it is trusted by 4 / 24: 1 / 6 / 4.01 + 5 / 6 / 0.26.
  const double left = 3.24669097 * (3. - 1) * (3. - 1) / 4;
  EXPECT_NEAR(left, error(1, 2, 1, 0.5), 1e-7);
  EXPECT_NEAR(estimated_error(film), left / 2, 1e-7);
  EXPECT_EQ(estimate_error(film).relmse_trimmed, estimated_error(film)) << "a thousandth of two pixels is none";
}

// Passes 1, 2, 6 of the left pixel: even ones have the mean 3.5, the odd one 2; their mean 3 leans to the first by 2
// : 1.
TEST(ErrorEstimate, WeighsUnequalHalves) {
  Film film = film_of(2, 1);
  for (const float v : {1.f, 2.f, 6.f}) pass(film, {Rgb(v, 1, 1), Rgb(1)});
  const double left = error(1.5 * 1.5 * 2 / 9, 3, (4. + 1 + 9) / 2 / 3, 1);  // in one channel of three
  EXPECT_NEAR(estimated_error(film), left / 6, 1e-12);
}

// Even passes 1 and, counting three, 6: 4.75 by four; odd ones 2 by one. Mean 4.2, mean square 22.6.
TEST(ErrorEstimate, WeighsHalvesByWhatPassesCountFor) {
  Film film = film_of(2, 1);
  for (const float v : {1.f, 2.f, 6.f}) pass(film, {Rgb(v, 1, 1), Rgb(1)}, {}, v > 2 ? 3 : 1);
  const double left = error(2.75 * 2.75 * 4 / 25, 4.2, (22.6 - 4.2 * 4.2) / 2, 1);
  EXPECT_NEAR(estimated_error(film), left / 6, 1e-12);
}

TEST(ErrorEstimate, CountsSplatsWithTheCamera) {
  Film film = film_of(2, 1, true);  // two light subpaths: splats count half
  pass(film, grey({1, 1}), grey({2, 0}));
  pass(film, grey({0, 1}), grey({0, 0}));
  EXPECT_NEAR(estimated_error(film), error(1, 1, 1, 1) / 2, 1e-12);
}

// What is done of the pass at work is in the image, so it lowers the error of the image.
TEST(ErrorEstimate, CountsThePassAtWorkByItsShare) {
  Film film = film_of(32, 16);  // two chunks
  std::vector<Rgb> bright(film.pixels(), Rgb(3)), dim(film.pixels(), Rgb(1));
  pass(film, bright);
  pass(film, dim);
  const double whole = estimated_error(film);
  EXPECT_NEAR(whole, error(1, 2, 1, 2), 1e-12);
  film.chunks = 1;
  EXPECT_NEAR(estimated_error(film), whole * 2 / 2.5, 1e-12);
}

// A pixel that one sample lit up is wrong by as much as it shines, and must not be excused by its own brightness.
TEST(ErrorEstimate, FirefliesCountInFullAndAreTrimmed) {
  Film film = film_of(40, 25);
  std::vector<Rgb> calm(film.pixels(), Rgb(1)), lit = calm;
  lit[12 * 40 + 20] = Rgb(2001);
  pass(film, lit);
  pass(film, calm);
  const double truth = 1000. * 1000 / 1.01 / 1000;
  EXPECT_NEAR(estimated_error(film), truth, 0.05 * truth);
  EXPECT_EQ(estimate_error(film).relmse_trimmed, 0) << "one of a thousand is left out";
}

// A lamp smaller than a pixel is bright among dark neighbours, and no firefly: three passes in four see it.
TEST(ErrorEstimate, DarkNeighboursDoNotDoubtWhatManyPassesSaw) {
  Film film = film_of(40, 25);
  std::vector<Rgb> dark(film.pixels(), Rgb(0.01f)), lit = dark;
  lit[12 * 40 + 20] = Rgb(100);
  for (int i = 0; i < 64; ++i) pass(film, i % 4 < 3 ? lit : dark);
  const double e = 1000 * estimated_error(film);  // (A - B)² / 4 = 25², over 75² or, where it is doubted, 64²
  EXPECT_GT(e, 625 / (75. * 75 + 0.01));
  EXPECT_LT(e, 625 / (64. * 64));
}

// In a corner of the picture the window is what is left of it: 3 x 3 pixels without the corner itself.
TEST(ErrorEstimate, NeighboursEndAtTheBorder) {
  Film film = film_of(5, 5);
  std::vector<Rgb> even(25, Rgb(0)), odd;
  for (const int i : {1, 6, 12}) even[size_t(i)] = Rgb(1);  // (1,0), (1,1), (2,2), all in reach of the corner
  even[3] = even[15] = Rgb(7);                              // (3,0) and (0,3), out of its reach
  odd = even;
  even[0] = Rgb(2);
  pass(film, even);
  pass(film, odd);
  EXPECT_NEAR(estimated_error(film), error(1, 1, 1, 3. / 8) / 25, 1e-12);
}

TEST(Variance, IsTheSpreadOfPassesOverTheirNumber) {
  Film film = film_of(1, 1);
  for (const float v : {1.f, 2.f, 6.f}) pass(film, grey({v}));
  EXPECT_NEAR(variance(film).pixels[0], (4. + 1 + 9) / 2 / 3, 1e-6);
}

TEST(Variance, IsFinite) {
  Film film = film_of(1, 1);
  for (const float v : {0.f, 1e20f}) pass(film, grey({v}));
  EXPECT_EQ(variance(film).pixels[0], std::numeric_limits<float>::max());
}

// Camera and splats (of one pixel, so not divided): 1 + 1 and 2 + 0, then three times 6 + 2, 4 + 4, 0 + 8.
TEST(Weights, PassesCountByThem) {
  Film film = film_of(1, 1, true);
  pass(film, grey({1}), grey({1}));
  pass(film, grey({2}), grey({0}));
  pass(film, grey({6}), grey({2}), 3);
  pass(film, grey({4}), grey({4}), 3);
  EXPECT_NEAR(develop(film).pixels[0], (2 + 2 + 3 * 8 + 3 * 8) / 8., 1e-6);
  EXPECT_NEAR(film.camera_sum[0].x / 4, (1 + 2 + 3 * 6 + 3 * 4) / 8., 1e-12);
  EXPECT_NEAR(film.half_sum[0].x / 2, (2 + 3 * 8) / 4., 1e-12);
  EXPECT_NEAR(film.square_sum[0].x / 4, (4 + 4 + 3 * 64 + 3 * 64) / 8., 1e-12);
  pass(film, grey({0}), grey({8}), 3);
  EXPECT_NEAR(film.splat_sum[0].x / 5, (1 + 0 + 3 * 2 + 3 * 4 + 3 * 8) / 11., 1e-12);
  EXPECT_NEAR(film.half_sum[0].x / 3, (2 + 3 * 8 + 3 * 8) / 7., 1e-12);
  drop_passes(film);
  EXPECT_EQ(film.weight, 0);
}

TEST(Weights, AlikeTheyChangeNothing) {
  Film ones = film_of(1, 1), threes = film_of(1, 1);
  for (const float v : {0.3f, 1.7f, 2.9f, 0.01f, 5.3f}) pass(ones, grey({v})), pass(threes, grey({v}), {}, 3);
  EXPECT_EQ(ones.camera_sum, threes.camera_sum);
  EXPECT_EQ(ones.half_sum, threes.half_sum);
  EXPECT_EQ(ones.square_sum, threes.square_sum);
}

TEST(Weights, WhatCameSinceIsWhatThosePassesBring) {
  Film film = film_of(1, 1), later = film_of(1, 1);
  for (const float v : {1.f, 5.f, 2.f, 2.f}) pass(film, grey({v}));
  const Film before = film;
  const float values[] = {3, 4, 7, 0, 1, 2};
  for (int i = 0; i < 6; ++i)
    for (Film* f : {&film, &later}) pass(*f, grey({values[i]}), {}, i < 2 ? 1.5 : 4);
  EXPECT_NEAR(sum_since(all_passes(film), all_passes(before), film.camera_sum[0], before.camera_sum[0]).x,
              later.camera_sum[0].x, 1e-12);
  EXPECT_NEAR(sum_since(even_passes(film), even_passes(before), film.half_sum[0], before.half_sum[0]).x,
              later.half_sum[0].x, 1e-12);
}

}  // namespace
}  // namespace ajar
