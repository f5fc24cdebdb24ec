#include "paths/distances.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace muster {

namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

double squared(double x) { return x * x; }

// The squared gap of each cell to the nearest blocked one of its own column: down the rows, and up again.
void along_columns(const bool* blocked, std::size_t rows, std::size_t columns, double trim, double* gaps) {
  std::vector<double> steps(columns, kInfinite);
  const auto sweep = [&](std::size_t row, auto&& keep) {
    for (std::size_t c = 0; c < columns; ++c) {
      const std::size_t at = row * columns + c;
      steps[c] = blocked[at] ? 0.0 : steps[c] + 1.0;
      keep(gaps[at], squared(std::max(steps[c] - trim, 0.0)));
    }
  };
  for (std::size_t row = 0; row < rows; ++row) sweep(row, [](double& gap, double found) { gap = found; });
  std::ranges::fill(steps, kInfinite);
  for (std::size_t row = rows; row-- > 0;) {
    sweep(row, [](double& gap, double found) { gap = std::min(gap, found); });
  }
}

// The lower envelope of the parabolas (x - c)^2 + gaps[c] ([felzenszwalb2012], Algorithm 1).
class Envelope {
 public:
  explicit Envelope(std::size_t columns) : roots_(columns), from_(columns) {}

  void build(const double* gaps, std::size_t columns) {
    gaps_ = gaps;
    size_ = 0;
    for (std::size_t c = 0; c < columns; ++c) {
      if (gaps[c] == kInfinite) continue;
      double from = -kInfinite;
      while (size_ > 0 && (from = meeting(roots_[size_ - 1], c)) <= from_[size_ - 1]) --size_;
      roots_[size_] = c;
      from_[size_] = size_ == 0 ? -kInfinite : from;
      ++size_;
    }
  }

  // The envelope at x; `piece` is where the last, smaller x was found.
  double at(double x, std::size_t& piece) const {
    if (size_ == 0) return kInfinite;
    while (piece + 1 < size_ && from_[piece + 1] < x) ++piece;
    return squared(x - static_cast<double>(roots_[piece])) + gaps_[roots_[piece]];
  }

 private:
  double meeting(std::size_t a, std::size_t b) const {
    const auto x = static_cast<double>(a), y = static_cast<double>(b);
    return ((gaps_[b] + y * y) - (gaps_[a] + x * x)) / (2.0 * (y - x));
  }

  const double* gaps_ = nullptr;
  std::size_t size_ = 0;
  std::vector<std::size_t> roots_;
  std::vector<double> from_;
};

}  // namespace

void squared_distances(const bool* blocked, std::size_t rows, std::size_t columns, double trim, double* squared) {
  along_columns(blocked, rows, columns, trim, squared);
  Envelope envelope(columns);
  std::vector<double> gaps(columns);
  for (std::size_t row = 0; row < rows; ++row) {
    double* line = squared + row * columns;
    std::copy_n(line, columns, gaps.begin());
    envelope.build(gaps.data(), columns);
    std::size_t left = 0, right = 0;
    for (std::size_t c = 0; c < columns; ++c) {
      // What is left of the cell is right at x - trim, what is right of it at x + trim; either is too far from the
      // other.
      const auto x = static_cast<double>(c);
      line[c] = std::min({gaps[c], envelope.at(x - trim, left), envelope.at(x + trim, right)});
    }
  }
}

}  // namespace muster
