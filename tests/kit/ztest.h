// Enters: two images with what tells their noise, made by different means.
// Leaves: the verdict whether all of their difference is noise.
#pragma once

#include <string>
#include <vector>

namespace ajar::kit {

/// Pixel means in rows, three channels interleaved (height * width * 3), and the variance *of these means*. The
/// variance of a sum of pixels is taken to be the sum of their variances: so one sample must not reach several pixels
/// (box filter, camera paths alone). Where it does (splats, wide filters, points that depend on each other) give runs.
struct Estimate {
  int width = 0, height = 0;
  std::vector<double> mean, variance;
  double dof =
      4;  ///< of each variance: values behind it less one; long tails make few of many, hence so small a number
  std::vector<std::vector<double>> runs;  ///< independent images, of which mean is the mean; may be empty
};

/// The estimate of some independent renderings (different seeds) of one image; at least two, better eight or more.
Estimate estimate(int width, int height, std::vector<std::vector<double>> runs);

/// Deviations that are expected besides noise: rounding, a bias that one of them may have.
struct Slack {
  double relative = 1e-4;  ///< to the brightness at hand
  double faint = 0;        ///< of a block, relative to the image's: what both hardly see, and one as good as never
};

struct ZTest {
  double p = 1;  ///< of the whole: the smallest of the three below, corrected for being one of three
  double p_max = 1, p_chi = 1, p_mean = 1;
  bool ok = false;               ///< p is at least the level
  int worst_x = 0, worst_y = 0;  ///< upper left pixel of the block that differs most
  int worst_channel = 0;
  double worst_z = 0;   ///< of that block
  std::string message;  ///< all of this in one line
};

/// Tests whether a and b have the same expectation in every pixel. Pixels are pooled in blocks of block x block; three
/// questions are asked, each of every channel: does one block differ (largest |z|, Sidak), do many differ a little
/// (chi-square), do all lean to one side (z of the mean, plain and relative to the brightness around). Built for
/// long-tailed noise: a z counts by Student's distribution with the degrees of freedom that its variance really has,
/// and no block is believed to be much quieter, relative to its brightness, than its neighbourhood (it may only have
/// missed the rare sample). Non-finite values and unequal sizes fail.
ZTest z_test(const Estimate& a, const Estimate& b, double level = 1e-4, int block = 4, const Slack& slack = {});

}  // namespace ajar::kit
