// Pictures: where an axis says that something is, it is drawn.

#include "driver/svg.hpp"

#include "driver/histogram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>
#include <vector>

namespace gcpdda::svg_test {
namespace {

struct Text {
  double x, y;
  std::string anchor, words;
};

std::vector<Text> texts_of(const std::string &svg) {
  std::vector<Text> found;
  const std::regex text("<text x=\"([-0-9.]+)\" y=\"([-0-9.]+)\" text-anchor=\"(\\w+)\"[^>]*>([^<]*)</text>");
  for (std::sregex_iterator at(svg.begin(), svg.end(), text); at != std::sregex_iterator(); ++at) {
    found.push_back({std::stod((*at)[1]), std::stod((*at)[2]), (*at)[3], (*at)[4]});
  }
  return found;
}

std::vector<std::vector<Vec2>> polygons_of(const std::string &svg) {
  std::vector<std::vector<Vec2>> found;
  const std::regex polygon("<polygon [^>]*points=\"([^\"]*)\"");
  const std::regex point("([-0-9.]+),([-0-9.]+)");
  for (std::sregex_iterator at(svg.begin(), svg.end(), polygon); at != std::sregex_iterator(); ++at) {
    const std::string points = (*at)[1];
    found.emplace_back();
    for (std::sregex_iterator p(points.begin(), points.end(), point); p != std::sregex_iterator(); ++p) {
      found.back().push_back({std::stod((*p)[1]), std::stod((*p)[2])});
    }
  }
  return found;
}

bool is_number(const std::string &words) {
  return std::regex_match(words, std::regex("-?[0-9.]+"));
}

/// Metres along an axis at a place in pixels, from the first and last number of the axis.
struct Axis {
  double pixel0 = 0.0, pixel1 = 0.0, metre0 = 0.0, metre1 = 0.0;
  int ticks = 0;

  [[nodiscard]] double at(double pixel) const {
    return metre0 + (metre1 - metre0) * (pixel - pixel0) / (pixel1 - pixel0);
  }
};

/// The numbers below x (m) are centred, those beside y (m) end at the axis.
Axis axis_of(const std::vector<Text> &texts, bool upright, double lowest_pixel) {
  Axis axis;
  for (const Text &text : texts) {
    const bool belongs = text.anchor == (upright ? "end" : "middle") && text.y < lowest_pixel;
    if (belongs && is_number(text.words)) {
      const double pixel = upright ? text.y - 0.35 * 18.0 : text.x; // of letters 18 pixels high
      (axis.ticks == 0 ? axis.pixel0 : axis.pixel1) = pixel;
      (axis.ticks == 0 ? axis.metre0 : axis.metre1) = std::stod(text.words);
      ++axis.ticks;
    }
  }
  return axis;
}

double end_of_axes(const std::vector<Text> &texts) { // the name of the x axis is below its numbers
  for (const Text &text : texts) {
    if (text.words == "x (m)") {
      return text.y;
    }
  }
  ADD_FAILURE() << "no x axis";
  return 0.0;
}

double pixel_of(const Axis &axis) { // in metres
  return std::abs((axis.metre1 - axis.metre0) / (axis.pixel1 - axis.pixel0));
}

void expect_corners(const std::vector<Vec2> &drawn, const std::vector<Vec2> &block, const Axis &along,
                    const Axis &up) {
  ASSERT_EQ(drawn.size(), block.size());
  for (std::size_t k = 0; k < block.size(); ++k) {
    EXPECT_NEAR(along.at(drawn[k].x), block[k].x, pixel_of(along));
    EXPECT_NEAR(up.at(drawn[k].y), block[k].y, pixel_of(up));
  }
}

void expect_axes_tell_where(const std::string &svg, const std::vector<std::vector<Vec2>> &blocks) {
  const std::vector<Text> texts = texts_of(svg);
  const double end = end_of_axes(texts);
  EXPECT_EQ(std::count_if(texts.begin(), texts.end(), [](const Text &t) { return t.words == "y (m)"; }), 1);
  const Axis along = axis_of(texts, false, end);
  const Axis up = axis_of(texts, true, end);
  ASSERT_GE(std::min(along.ticks, up.ticks), 2);
  const std::vector<std::vector<Vec2>> drawn = polygons_of(svg);
  ASSERT_EQ(drawn.size(), blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    expect_corners(drawn[b], blocks[b], along, up);
  }
}

const std::vector<std::vector<Vec2>> shapes{{{-3.0, 100.0}, {17.0, 100.0}, {17.0, 101.0}, {-3.0, 101.0}},
                                            {{0.5, 101.0}, {1.5, 101.0}, {1.0, 102.5}}};

TEST(Pictures, AxesTellWhereBlocksAre) {
  expect_axes_tell_where(draw_svg({{shapes[0], -1, false}, {shapes[1], 0, true}}, 1), shapes);
}

// Numbers of seven digits, all of which are on the page.
TEST(Pictures, AxesTellWhereBlocksAreInMapCoordinates) {
  std::vector<std::vector<Vec2>> far = shapes;
  for (std::vector<Vec2> &shape : far) {
    for (Vec2 &p : shape) {
      p += Vec2{5450000.0, 4999900.0};
    }
  }
  const std::string svg = draw_svg({{far[0], -1, false}, {far[1], 0, true}}, 1);
  expect_axes_tell_where(svg, far);
  std::smatch size;
  ASSERT_TRUE(std::regex_search(svg, size, std::regex("width=\"([0-9]+)\"")));
  constexpr double digit = 11.4; // pixels, of a wide font
  for (const Text &text : texts_of(svg)) {
    if (is_number(text.words)) {
      const double width = digit * static_cast<double>(text.words.size());
      EXPECT_GE(text.x - (text.anchor == "end" ? width : 0.5 * width), 0.0) << text.words;
      EXPECT_LE(text.x + (text.anchor == "end" ? 0.0 : 0.5 * width), std::stod(size[1])) << text.words;
    }
  }
}

constexpr double failing_factor = 1.25;

std::vector<FailingBlock> sliding(double motion) {
  std::vector<FailingBlock> blocks;
  for (const std::vector<Vec2> &shape : shapes) {
    FailingBlock block;
    block.vertices = shape;
    block.fixed = blocks.empty();
    block.motion = block.fixed ? 0.0 : motion;
    block.displacement = {block.motion, 0.0};
    block.moves = block.motion > 0.0;
    blocks.push_back(block);
  }
  return blocks;
}

TEST(Pictures, AMechanismHasAColourBarFromZeroToTheLargestMotion) {
  const std::string svg = draw_mechanism(sliding(0.35), {}, failing_factor);
  expect_axes_tell_where(svg, shapes);
  const std::vector<Text> texts = texts_of(svg);
  const double end = end_of_axes(texts);
  const std::regex cell("<rect x=\"([0-9.]+)\" y=\"[0-9.]+\" width=\"([0-9.]+)\"[^>]*fill=\"hsl");
  double begin_of_bar = 1e9;
  double end_of_bar = 0.0;
  for (std::sregex_iterator at(svg.begin(), svg.end(), cell); at != std::sregex_iterator(); ++at) {
    begin_of_bar = std::min(begin_of_bar, std::stod((*at)[1]));
    end_of_bar = std::max(end_of_bar, std::stod((*at)[1]) + std::stod((*at)[2]));
  }
  ASSERT_GT(end_of_bar, begin_of_bar);
  int ticks = 0;
  for (const Text &text : texts) {
    if (text.y > end && text.anchor == "middle") {
      const double share = (text.x - begin_of_bar) / (end_of_bar - begin_of_bar);
      EXPECT_NEAR(0.35 * share, std::stod(text.words), 1e-3) << "a tick is where its colour is";
      ++ticks;
    }
  }
  EXPECT_GE(ticks, 3);
  EXPECT_EQ(std::count_if(texts.begin(), texts.end(), [](const Text &t) { return t.words == "motion (m)"; }),
            1);
}

TEST(Pictures, BlocksCloseTogetherShareAnArrow) {
  std::vector<FailingBlock> blocks = sliding(0.35);
  const auto lines = [&] { // three an arrow, as wide as no other line
    const std::string svg = draw_mechanism(blocks, {}, failing_factor);
    const std::regex line("<path stroke=\"#333\" stroke-width=\"1.6\"");
    return std::distance(std::sregex_iterator(svg.begin(), svg.end(), line), std::sregex_iterator());
  };
  EXPECT_EQ(lines(), 3);
  blocks.push_back(blocks.back()); // at the same place
  EXPECT_EQ(lines(), 3);
  for (Vec2 &vertex : blocks.back().vertices) {
    vertex.x += 3.0; // 180 pixels
  }
  EXPECT_EQ(lines(), 6);
}

TEST(Pictures, AMechanismWithoutMotionIsDrawnToo) {
  const std::string svg = draw_mechanism(sliding(0.0), {}, failing_factor);
  expect_axes_tell_where(svg, shapes);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

/// Lines of a colour that lie within the axes, in metres.
std::vector<FailingJoints::Line> lines_of(const std::string &svg, const std::string &colour) {
  const std::vector<Text> texts = texts_of(svg);
  const double end = end_of_axes(texts);
  const Axis along = axis_of(texts, false, end);
  const Axis up = axis_of(texts, true, end);
  std::vector<FailingJoints::Line> found;
  const std::regex line("<path stroke=\"" + colour +
                        "\"[^>]*d=\"M([-0-9.]+) ([-0-9.]+)L([-0-9.]+) ([-0-9.]+)\"");
  for (std::sregex_iterator at(svg.begin(), svg.end(), line); at != std::sregex_iterator(); ++at) {
    if (std::stod((*at)[2]) < end) {
      found.push_back({Vec2{along.at(std::stod((*at)[1])), up.at(std::stod((*at)[2]))},
                       Vec2{along.at(std::stod((*at)[3])), up.at(std::stod((*at)[4]))}});
    }
  }
  return found;
}

TEST(Pictures, AMechanismShowsWhereItsJointsSlipAndHaveOpened) {
  FailingJoints joints;
  joints.slipping = {{Vec2{0.5, 101.0}, Vec2{1.5, 101.0}}};
  joints.opened = {{Vec2{-1.0, 100.5}, Vec2{-1.0, 101.0}}, {Vec2{-0.5, 100.5}, Vec2{-0.5, 101.0}}};
  joints.knows_opened = true;
  const std::string svg = draw_mechanism(sliding(0.35), joints, failing_factor);
  const auto expect_lines = [&](const std::string &colour, const std::vector<FailingJoints::Line> &wanted) {
    const std::vector<FailingJoints::Line> drawn = lines_of(svg, colour);
    ASSERT_EQ(drawn.size(), wanted.size()) << colour;
    for (std::size_t k = 0; k < drawn.size(); ++k) {
      for (std::size_t end = 0; end < 2; ++end) {
        EXPECT_LT(norm(drawn[k][end] - wanted[k][end]), 0.05) << "a pixel is 17 mm";
      }
    }
  };
  expect_lines("#7a0fa8", joints.slipping);
  expect_lines("#0f8bd0", joints.opened);
  EXPECT_NE(svg.find(">joint that slips<"), std::string::npos);
  EXPECT_NE(svg.find(">joint that has opened<"), std::string::npos);
  joints.opened.clear();
  joints.knows_opened = false;
  EXPECT_NE(draw_mechanism(sliding(0.35), joints, failing_factor).find("output.contacts = true"),
            std::string::npos)
      << "a picture without opened joints says why";
}

TEST(Pictures, AHistogramCountsItsMembers) {
  EnsembleReport report;
  for (const double factor : {0.91, 1.02, 1.03, 1.11, 1.12, 1.13, 1.31}) {
    EnsembleMember member;
    member.number = static_cast<std::int64_t>(report.members.size());
    member.outcome = MemberOutcome::holds;
    member.holds = factor - 0.005;
    member.fails = factor + 0.005;
    report.members.push_back(member);
  }
  const std::string svg = draw_factors(report);
  const std::vector<Text> texts = texts_of(svg);
  Axis up;
  for (const Text &text : texts) {
    if (text.anchor == "end") {
      (up.ticks == 0 ? up.pixel0 : up.pixel1) =
          text.y - 5.0; // the base line of letters is below their middle
      (up.ticks == 0 ? up.metre0 : up.metre1) = std::stod(text.words);
      ++up.ticks;
    }
  }
  ASSERT_GE(up.ticks, 2);
  double members = 0.0;
  for (const std::vector<Vec2> &bar : polygons_of(svg)) {
    members += up.at(bar[2].y); // its upper side
    EXPECT_NEAR(up.at(bar[0].y), 0.0, 1e-2);
  }
  EXPECT_NEAR(members, static_cast<double>(report.members.size()), 1e-2);
  EXPECT_EQ(std::count_if(texts.begin(), texts.end(), [](const Text &t) { return t.words == "members"; }), 1);
}

} // namespace
} // namespace gcpdda::svg_test
