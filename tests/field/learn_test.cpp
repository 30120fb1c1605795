// Lessons of hand-made records, against figures computed by hand.
#include <gtest/gtest.h>

#include <thread>

#include "ajar/core/sampler.h"
#include "kit/stage.h"
#include "lesson.h"

namespace ajar {
namespace {

TEST(Learn, EvidenceMovesItsStratumAlone) {
  for (const Side side : {Side::camera, Side::light}) {
    const Fields blank = one_cell();
    ASSERT_EQ(blank.cells.size(), 1u);
    Lesson first(blank, side);
    first.add(towards(5), 3, 2);
    const Fields a = first.learned(whole_strata());
    EXPECT_FLOAT_EQ(mean_of(a.of(side), 5), 3);
    EXPECT_FLOAT_EQ(weight_of(a.of(side), 5), 2);
    for (int i = 0; i < 16; ++i) EXPECT_EQ(mean_of(a.of(side), i), i == 5 ? 3 : 0) << i;
    const Side other = side == Side::camera ? Side::light : Side::camera;
    EXPECT_EQ(mean_of(a.of(other), 5), 0);

    // Half of the older weight 2 is kept: 3 + (5 - 3) * 1 / (1 + 1).
    Lesson second(a, side);
    second.add(towards(5), 5, 1);
    const Fields b = second.learned(whole_strata());
    EXPECT_FLOAT_EQ(mean_of(b.of(side), 5), 4);
    EXPECT_FLOAT_EQ(weight_of(b.of(side), 5), 2);

    // Records of one lesson are averaged by weight: (1 * 7 + 3 * 1) / 4 = 2.5; 4 + (2.5 - 4) * 4 / (1 + 4).
    Lesson third(b, side);
    third.add(towards(5, {0.1f, 0.9f}), 7, 1), third.add(towards(5, {0.9f, 0.1f}), 1, 3);
    EXPECT_NEAR(mean_of(third.learned(whole_strata()).of(side), 5), 2.8f, 2.8f / 512);
    EXPECT_EQ(third.learned(whole_strata()).generation, blank.generation + 3);
  }
}

TEST(Learn, ZerosPullDownAndSilenceDoesNot) {
  const Fields blank = one_cell();
  Lesson first(blank);
  first.add(towards(9), 3, 2), first.add(towards(2), 1, 2);
  const Fields a = first.learned(whole_strata());
  Lesson second(a);
  second.add(towards(9), 0, 3);
  const Fields b = second.learned(whole_strata());
  EXPECT_FLOAT_EQ(mean_of(b.q, 9), 0.75f);  // 3 + (0 - 3) * 3 / (1 + 3)
  EXPECT_FLOAT_EQ(mean_of(b.q, 2), 1);
  EXPECT_FLOAT_EQ(weight_of(b.q, 2), 2) << "nothing new was seen there, nothing is forgotten";
}

// More than 64 bits hold, from the first record to the last and the other way round: as much as they hold.
TEST(Learn, SumsEndWhereTheyAreFull) {
  const Fields blank = one_cell();
  const auto tallies = [&](bool backwards) {
    Lesson lesson(blank);
    constexpr int n = 10000;
    for (int k = 0; k < n; ++k) {
      const int i = backwards ? n - 1 - k : k;
      const float value = i % 3 == 0 ? 1.5f + float(i) : 1e20f;
      lesson.add(towards(i % 2), value, 1 + float(i % 64));
      record_direct(lesson.fields.q, lesson.training.q, 0, value);
    }
    return lesson;
  };
  const Lesson forth = tallies(false), back = tallies(true);
  EXPECT_TRUE(same_training(forth.training.q, back.training.q));
  EXPECT_EQ(forth.training.q.held, back.training.q.held);
  EXPECT_EQ(forth.training.q.direct[0], int64_t(1) << 62);
  const Fields f = forth.learned(whole_strata());
  EXPECT_GT(mean_of(f.q, 0), 1e3f);
  EXPECT_LT(mean_of(f.q, 0), infinity);
  EXPECT_GT(f.q.cells[0].direct, 1e3f);
}

// What guides hardly better than the surface does by itself is left out.
TEST(Learn, EvenFieldsDoNotGuide) {
  const auto mix = [](float brightest, float least_contrast) {
    Lesson lesson(one_cell());
    for (int i = 0; i < 16; ++i) lesson.add(towards(i), i == 5 ? brightest : 1.0f, 1);
    LearnOptions options = whole_strata();
    options.least_contrast = least_contrast;
    const FieldCell cell = lesson.learned(options).q.cells[0];
    EXPECT_GT(cell.mix, 0) << "it is trusted all the same";
    return mix_of(cell);
  };
  EXPECT_EQ(mix(1, 2), 0);
  EXPECT_EQ(mix(4, 2), 0) << "mean square 1.4 times the square of the mean";
  EXPECT_GT(mix(20, 2), 0) << "5 times";
  EXPECT_EQ(mix(20, 10), 0) << "5 times";
  EXPECT_GT(mix(200, 10), 0) << "14 times";
}

// Brightest at stratum 5; as much evidence as a cell has after a few lessons.
Fields lesson_of(const Fields& before, float brightest, bool steady) {
  LearnOptions options = whole_strata();
  options.steady = steady, options.forget = 0.8f;
  Lesson lesson(before);
  for (int i = 0; i < 16; ++i) lesson.add(towards(i), i == 5 ? brightest : 1.0f, 1000);
  record_visit(lesson.training.q, 0);
  record_direct(lesson.fields.q, lesson.training.q, 0, 1);
  return lesson.learned(options);
}

TEST(Learn, SteadyFieldsStayUntilTheyAreContradicted) {
  const Fields a = lesson_of(lesson_of(one_cell(), 20, false), 20, false);
  const auto shares = [](const Fields& f) { return f.q.nodes[f.q.cells[0].root]; };
  const auto stays = [&](const Fields& f) {
    const FieldCell &x = f.q.cells[0], &y = a.q.cells[0];
    return shares(f) == shares(a) && x.total == y.total && x.direct == y.direct && x.mix == y.mix && x.near == y.near;
  };
  const Fields noise = lesson_of(a, 20.5f, true);
  EXPECT_TRUE(stays(noise));
  EXPECT_FALSE(stays(lesson_of(a, 20.5f, false)));
  EXPECT_GT(mean_of(noise.q, 5), 20.1f) << "evidence goes on";
  EXPECT_FALSE(stays(lesson_of(a, 60, true)));
  EXPECT_GT(lesson_of(a, 60, true).q.cells[0].total, 1.3f * a.q.cells[0].total);

  // What changes little at a time is seen as well.
  Fields slow = a;
  int lessons = 0;
  float value = 20;
  for (; stays(slow) && lessons < 20; ++lessons) slow = lesson_of(slow, value *= 1.03f, true);
  EXPECT_GT(lessons, 2);
  EXPECT_LT(lessons, 15);
  EXPECT_NEAR(slow.q.cells[0].total, lesson_of(slow, value, false).q.cells[0].total, 0.1f * slow.q.cells[0].total);
}

TEST(Learn, TotalsAreIrradianceAndMixIsTrust) {
  Lesson lesson(one_cell());
  for (int i = 0; i < 16; ++i) lesson.add(towards(i), 2, 1);
  record_direct(lesson.fields.q, lesson.training.q, 0, 5), record_direct(lesson.fields.q, lesson.training.q, 0, 0);
  for (int i = 0; i < 3; ++i) record_visit(lesson.training.q, 0);
  LearnOptions options;
  options.mix = 0.6f, options.trust = 48;
  const double paths = 10, area = sqr(double(lesson.fields.table.width));
  const FieldCell cell = learn(lesson.fields, lesson.training, {}, paths, options).q.cells[0];
  EXPECT_FLOAT_EQ(cell.direct, 2.5f);
  EXPECT_NEAR(cell.total, 2.5 + 2 * pi, 0.25) << "radiance 2 from everywhere, and the direct light";
  EXPECT_FLOAT_EQ(cell.mix, 0.6f * 16 / (16 + 48));
  EXPECT_NEAR(cell.visits, 3 / (area * paths), 1e-5 * cell.visits);
  for (int i = 0; i < 3; ++i) record_visit(lesson.training.w, 0);
  const Fields both = learn(lesson.fields, lesson.training, {}, {paths, paths / 2}, options);
  EXPECT_EQ(both.q.cells[0].visits, cell.visits);
  EXPECT_NEAR(both.w.cells[0].visits, 2 * cell.visits, 1e-5 * cell.visits) << "of as many visits of half the paths";
}

TEST(Learn, SharesAreProjectedSolidAngleTimesMean) {
  Lesson lesson(one_cell());
  for (int i = 0; i < 16; ++i) lesson.add(towards(i), i == 6 ? 4.0f : 1.0f, 1);
  LearnOptions options;
  options.divide_stratum = 1;
  const Fields f = lesson.learned(options);
  double area[16] = {}, sum = 0, bare = 0;
  const int n = 400;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const Vec2 at((float(x) + 0.5f) / n, (float(y) + 0.5f) / n);
      const Vec3 w = from_square(at);
      area[Descent(at).next()] += double(w.z / square_density(w)) / (double(n) * n);
    }
  for (int i = 0; i < 16; ++i) bare += area[i] * (i == 6 ? 4 : 1);
  const double floor = 0.03 * bare / std::numbers::pi;  // 3 % of the mean are everywhere
  for (int i = 0; i < 16; ++i) sum += area[i] *= (i == 6 ? 4 : 1) + floor;
  for (int i = 0; i < 16; ++i)
    EXPECT_NEAR(f.q.nodes[f.q.cells[0].root].steps(i) / 65536.0, area[i] / sum, 0.08 * area[i] / sum)
        << i;  // areas are by few points
}

TEST(Learn, HeavyStrataDivideAndLightOnesJoin) {
  const Fields blank = one_cell();
  Lesson first(blank);
  for (int i = 0; i < 16; ++i) first.add(towards(i), i == 5 ? 1.0f : 0.0f, i == 5 ? 16.0f : 1.0f);
  const Fields a = first.learned();
  const StrataNode& root = a.q.nodes[a.q.cells[0].root];
  EXPECT_EQ(root.divided, 1u << 5);
  ASSERT_EQ(a.q.nodes.size(), 2u);
  for (size_t i = 0; i < 16; ++i) {
    EXPECT_FLOAT_EQ(a.q.mean[16 * root.child(5) + i], 1);
    EXPECT_EQ(a.q.weight[16 * root.child(5) + i], kept(0.1f)) << "a tenth of the whole's evidence";
  }
  EXPECT_FLOAT_EQ(a.q.cells[0].mix, 0.8f * 31 / (31 + 32)) << "dividing costs no trust";
  EXPECT_EQ(a.w.nodes.size(), 1u);

  LearnOptions visits;
  visits.forget = 1;
  const Fields whole = first.learned(visits);
  EXPECT_EQ(whole.q.weight[16 * whole.q.nodes[whole.q.cells[0].root].child(5)], kept(1)) << "nothing is forgotten";

  LearnOptions tight;
  tight.memory = bytes(blank);
  EXPECT_EQ(first.learned(tight).q.nodes.size(), 1u) << "no memory is left";

  // Evidence goes to the part that it is for, and counts ten times what the part began with.
  Lesson part(a);
  part.add(towards(5, {0.9f, 0.9f}), 4, 0.5f);
  const Fields p = part.learned(whole_strata());
  const uint32_t child = p.q.nodes[p.q.cells[0].root].child(5);
  EXPECT_EQ(p.q.mean[16 * child + 15], kept(1 + 3 * 0.5f / 0.55f));
  EXPECT_FLOAT_EQ(p.q.mean[16 * child + 14], 1);

  Lesson second(a);
  for (int j = 0; j < 16; ++j)
    second.add(towards(5, (Vec2(j & 3, j >> 2) + 0.5f) / 4.0f), 0, 32);  // kept 0.05: mean 0.05 / 32.05
  second.add(towards(10), 8, 4);
  const Fields b = second.learned();
  const StrataNode& joined = b.q.nodes[b.q.cells[0].root];
  EXPECT_FALSE(joined.is_divided(5));
  EXPECT_NEAR(mean_of(b.q, 5), 0.05f / 32.05f, 1e-5f);
  EXPECT_EQ(weight_of(b.q, 5), kept(16 * 32.05f));
}

// Few records are made in narrow strata, and each weighs little: those that hold much of the field need less weight.
TEST(Learn, LittleEvidenceDoesNotDivide) {
  for (const bool divides : {false, true}) {
    Lesson narrow(one_cell()), even(one_cell());
    narrow.add(towards(5), 1, divides ? 1.0f : 0.5f);
    EXPECT_EQ(narrow.learned().q.nodes.size() > 1, divides);
    for (int i = 0; i < 16; ++i) even.add(towards(i), 1, divides ? 12.0f : 5.0f);
    EXPECT_EQ(even.learned().q.nodes.size() > 1, divides);
  }
}

TEST(Learn, DivisionEndsAtTheLastLevel) {
  Fields f = one_cell();
  for (int pass = 0; pass < 12; ++pass) {
    Lesson lesson(f);
    for (int i = 0; i < 20; ++i) lesson.add(towards(6, {0.3f, 0.7f}), 100, 60);
    for (int y = 0; y < 256; ++y)  // darkness around
      for (int x = 0; x < 256; ++x) lesson.add(from_square((Vec2(float(x), float(y)) + 0.5f) / 256.0f), 0, 0.25f);
    f = lesson.learned();
  }
  int levels = 1;
  Descent down(to_square(towards(6, {0.3f, 0.7f})));
  uint32_t node = f.q.cells[0].root;
  for (int i = down.next(); f.q.nodes[node].is_divided(i); i = down.next(), ++levels) node = f.q.nodes[node].child(i);
  EXPECT_EQ(levels, most_levels);
}

struct Record {
  Vec3 w;
  float value, weight;
};
std::vector<Record> random_records(int n) {
  Sampler sampler = make_sampler(SamplerKind::independent, 7, Side::camera, 0, 0);
  std::vector<Record> out;
  for (int i = 0; i < n; ++i) {
    const Vec3 w = from_square(sampler.next2());
    const Vec2 u = sampler.next2();
    out.push_back({w, std::exp(12 * u.x - 8), 3 * u.y});
  }
  return out;
}

TEST(Learn, OrderAndThreadsDoNotMatter) {
  const Fields blank = one_cell();
  std::vector<Record> records = random_records(20000);
  const auto tell = [](Lesson& lesson, const Record& r) {
    lesson.add(r.w, r.value, r.weight);
    record_direct(lesson.fields.q, lesson.training.q, 0, r.value);
    record_visit(lesson.training.q, 0);
  };
  Lesson straight(blank), backwards(blank), together(blank);
  for (const Record& r : records) tell(straight, r);
  for (size_t i = records.size(); i-- > 0;) tell(backwards, records[i]);
  std::vector<std::thread> threads;
  for (size_t k = 0; k < 4; ++k)
    threads.emplace_back([&, k] {
      for (size_t i = k; i < records.size(); i += 4) tell(together, records[i]);
    });
  for (std::thread& t : threads) t.join();
  EXPECT_TRUE(same_training(straight.training.q, backwards.training.q));
  EXPECT_TRUE(same_training(straight.training.q, together.training.q));
  EXPECT_TRUE(same_field(straight.learned().q, backwards.learned().q));
  EXPECT_TRUE(same_field(straight.learned().q, together.learned().q));
  records[4711].value *= 2;
  Lesson other(blank);
  for (const Record& r : records) tell(other, r);
  EXPECT_FALSE(same_field(straight.learned().q, other.learned().q));
}

TEST(Learn, BadRecordsAreIgnored) {
  const Fields blank = one_cell();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Lesson bad(blank);
  const Vec3 w = towards(5);
  bad.add(w, -1, 1), bad.add(w, nan, 1);
  bad.add(w, 1, 0), bad.add(w, 1, -1), bad.add(w, 1, nan);
  bad.add(-w, 1, 1), bad.add({1, 0, 0}, 1, 1), bad.add(Vec3(nan), 1, 1);
  EXPECT_TRUE(same_training(bad.training.q, start_training(blank).q));
  Lesson huge(blank);
  for (int i = 0; i < 64; ++i) huge.add(w, i % 2 ? 1e38f : infinity, i % 3 ? 1e38f : infinity);
  record_direct(blank.q, huge.training.q, 0, infinity), record_direct(blank.q, huge.training.q, 0, nan);
  LearnOptions undivided;
  undivided.divide_stratum = 1;
  const Fields f = huge.learned(undivided);
  EXPECT_TRUE(mean_of(f.q, 5) > 0 && mean_of(f.q, 5) < infinity);
  EXPECT_TRUE(f.q.cells[0].total >= 0 && f.q.cells[0].total < infinity);
  EXPECT_TRUE(f.q.cells[0].mix >= 0 && f.q.cells[0].mix < 1);
}

TEST(Learn, StartsFromNothing) {
  Scene empty;
  finish(empty);
  for (const Scene& scene : {empty, [] {
                               Scene s = kit::stage();
                               s.lights.clear();
                               for (Shape& shape : s.shapes) shape.light = none;
                               finish(s);
                               return s;
                             }()}) {
    const Fields f = start_fields(scene, 100);
    EXPECT_TRUE(f.q.unit > 0 && f.q.unit < double(infinity)) << f.q.unit;
    EXPECT_TRUE(f.w.unit > 0 && f.w.unit < double(infinity)) << f.w.unit;
    EXPECT_EQ(find(f.table, Vec3(0.5f), up).cell, none);
    const Fields next = learn(f, start_training(f), {}, 100, {});
    EXPECT_TRUE(next.cells.empty());
    EXPECT_EQ(next.generation, 1u);
  }
}

}  // namespace
}  // namespace ajar
