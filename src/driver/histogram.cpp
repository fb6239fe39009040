#include "driver/histogram.hpp"

#include "base/round_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <optional>
#include <utility>

namespace gcpdda {

namespace {

constexpr const char *mean_colour = "#2a7f3f";

/// Bars on a page with an axis and lines of text above.
class Chart {
public:
  Chart(const Bars &bars, std::int64_t highest)
      : bars_(bars), highest_(static_cast<double>(highest)),
        text_(fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
                          "font-family=\"sans-serif\" font-size=\"14\">\n"
                          "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
                          width + 2.0 * margin, top + height + bottom)) {}

  [[nodiscard]] double x_of(double value) const {
    const double range = bars_.width * static_cast<double>(bars_.counts.size());
    return margin + width * (value - bars_.begin) / range;
  }

  void write(double x, double y, const std::string &anchor, const std::string &text) {
    text_ +=
        fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor, text);
  }

  void bar(std::size_t k, const std::string &colour) {
    const double left = x_of(edge(k));
    const double tall = height * static_cast<double>(bars_.counts[k]) / highest_;
    const double right = x_of(edge(k + 1));
    const double below = top + height;
    text_ += fmt::format("<polygon fill=\"{0}\" stroke=\"#333\" stroke-width=\"0.5\" "
                         "points=\"{1:.1f},{3:.1f} {2:.1f},{3:.1f} {2:.1f},{4:.1f} {1:.1f},{4:.1f}\"/>\n",
                         colour, left, right, below, below - tall);
    if (bars_.counts[k] > 0) {
      write(0.5 * (left + right), top + height - tall - 5.0, "middle", fmt::format("{}", bars_.counts[k]));
    }
  }

  void upright(double value, const std::string &colour) {
    line(x_of(value), top - 12.0, x_of(value), top + height, colour);
  }

  /// Below the bars their edges, on the left how many members they have.
  void axes(const std::string &title) {
    const double base = top + height;
    line(margin, base, margin + width, base, "#333");
    line(margin, top, margin, base, "#333");
    const std::size_t every = bars_.counts.size() / 12 + 1;
    for (std::size_t k = 0; k <= bars_.counts.size(); k += every) {
      line(x_of(edge(k)), base, x_of(edge(k)), base + 5.0, "#333");
      write(x_of(edge(k)), base + 20.0, "middle", fmt::format("{:.4g}", edge(k)));
    }
    write(margin + 0.5 * width, base + 42.0, "middle", title);
    for (const double count : round_ticks(0.0, highest_, std::min(5, static_cast<int>(highest_)))) {
      const double y = base - height * count / highest_;
      line(margin - 5.0, y, margin, y, "#333");
      write(margin - 9.0, y + 5.0, "end", fmt::format("{:.4g}", count));
    }
    write(margin, top - 14.0, "middle", "members");
  }

  [[nodiscard]] double edge(std::size_t k) const {
    return bars_.begin + bars_.width * static_cast<double>(k);
  }
  [[nodiscard]] std::string whole() const { return text_ + "</svg>\n"; }

  static constexpr double margin = 60.0; // pixels, as all lengths here
  static constexpr double width = 800.0;
  static constexpr double height = 320.0;
  static constexpr double top = 104.0;
  static constexpr double bottom = 56.0;

private:
  void line(double x0, double y0, double x1, double y1, const std::string &colour) {
    text_ += fmt::format("<path d=\"M {:.1f} {:.1f} L {:.1f} {:.1f}\" stroke=\"{}\" stroke-width=\"1.5\"/>\n",
                         x0, y0, x1, y1, colour);
  }

  const Bars &bars_;
  double highest_;
  std::string text_;
};

/// What a picture shows.
struct Histogram {
  std::vector<double> values; ///< at least one
  std::string title;
  double edge = 0.0; ///< of a bar
  std::function<bool(double)> is_failure;
  std::vector<std::pair<double, std::string>> lines; ///< upright ones: where, and colour
  std::vector<std::string> words;                    ///< rows above the bars
};

std::string drawn(const Histogram &histogram) {
  const Bars bars = bars_of(histogram.values, histogram.edge);
  Chart chart(bars, *std::max_element(bars.counts.begin(), bars.counts.end()));
  for (std::size_t k = 0; k < bars.counts.size(); ++k) {
    chart.bar(k, histogram.is_failure(chart.edge(k) + 0.5 * bars.width) ? "#d1583f" : "#8aa9c8");
  }
  chart.axes(histogram.title);
  for (const auto &[place, colour] : histogram.lines) {
    if (chart.edge(0) <= place && place <= chart.edge(bars.counts.size())) {
      chart.upright(place, colour);
    }
  }
  double row = 22.0; // pixels
  for (const std::string &words : histogram.words) {
    chart.write(Chart::margin, row, "start", words);
    row += 20.0;
  }
  return chart.whole();
}

std::string words_on_probability(const EnsembleStatistics &found) {
  return fmt::format("probability of failure {:.3g}, {:.2g} to {:.2g} with 95 % confidence: {} of {} fail",
                     found.probability, found.interval.low, found.interval.high, found.fails, found.trials());
}

} // namespace

Bars bars_of(const std::vector<double> &values, double edge) {
  const SampleMoments moments = sample_moments(values);
  const double scott =
      3.49 * moments.deviation / std::cbrt(static_cast<double>(std::max<std::size_t>(values.size(), 1)));
  Bars bars;
  bars.width = round_number(scott > 0.0 ? scott : 0.01);
  const auto number_of_bar = [&](double x) { return std::floor((x - edge) / bars.width); };
  const double first = number_of_bar(moments.least);
  bars.begin = edge + bars.width * first;
  bars.counts.resize(static_cast<std::size_t>(number_of_bar(moments.most) - first) + 1);
  for (const double x : values) {
    ++bars.counts[static_cast<std::size_t>(number_of_bar(x) - first)];
  }
  return bars;
}

std::string draw_factors(const EnsembleReport &report) {
  const EnsembleStatistics found = statistics_of(report);
  Histogram histogram;
  for (const EnsembleMember &member : report.members) {
    if (const std::optional<double> factor = member.factor()) {
      histogram.values.push_back(*factor);
    }
  }
  histogram.title = "factor of safety";
  histogram.edge = 1.0;
  histogram.is_failure = [](double factor) { return factor < 1.0; };
  histogram.lines = {{1.0, "black"}, {found.factor.mean, mean_colour}};
  const std::int64_t aside = found.trials() - found.factor.number;
  histogram.words = {fmt::format("{} members: mean {:.4g} (green), standard deviation {:.3g}",
                                 found.factor.number, found.factor.mean, found.factor.deviation),
                     words_on_probability(found)};
  if (aside > 0) {
    histogram.words.push_back(fmt::format("{} members without a factor are not shown", aside));
  }
  return drawn(histogram);
}

std::string draw_displacements(const EnsembleReport &report) {
  const EnsembleStatistics found = statistics_of(report);
  const double largest = report.largest_displacement;
  Histogram histogram;
  for (const EnsembleMember &member : report.members) {
    if (member.displacement) {
      histogram.values.push_back(*member.displacement);
    }
  }
  histogram.title = "permanent displacement, m";
  histogram.edge = std::isfinite(largest) ? largest : 0.0;
  histogram.is_failure = [&](double displacement) { return displacement > largest; };
  histogram.lines = {{largest, "black"}, {found.median_displacement, mean_colour}};
  const std::int64_t aside = found.trials() - found.displacement.number;
  histogram.words = {fmt::format("{} members at rest: median {:.3g} m (green), mean {:.3g} m",
                                 found.displacement.number, found.median_displacement,
                                 found.displacement.mean),
                     words_on_probability(found)};
  if (aside > 0) {
    histogram.words.push_back(fmt::format("{} members that did not come to rest are not shown", aside));
  }
  return drawn(histogram);
}

} // namespace gcpdda
