// [hart1968] over the taut pieces of [oh2017].
#include "paths/corner_search.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

#include "heap.hpp"
#include "infinity.hpp"

namespace muster {

namespace {

constexpr double kBoundRounding = 1e-9;  // so that a way as short as the best one known is found again

class CornerSearch {
 public:
  CornerSearch(const Sights& sights, Point from, Point to)
      : sights_(sights), from_(from), to_(to), at_from_(sights.snap(from)), at_to_(sights.snap(to)) {}

  CornerWay run() {
    const std::optional<double> some = sights_.some_length(from_, to_);
    if (!some) return {{}, kFar, looks_};
    bound_ = *some * (1.0 + kBoundRounding);
    for (const int corner : sights_.seen_from(at_to_, {to_, from_, bound_})) {
      rest_[corner] = distance(place(corner), to_);
    }
    for (const int corner : sights_.seen_from(at_from_, {from_, to_, bound_})) {
      reach({distance(from_, place(corner)), corner, -1, true});
    }
    while (!open_.empty() && open_.top().key < bound_) {
      const Step step = open_.pop().step;
      if (step.length >= length_of(step.corner) || !seen(step)) continue;
      found_[step.corner] = {step.length, step.parent};
      arrive(step);
      expand(step);
    }
    return {way(), length_, looks_};
  }

 private:
  // A way to a corner, and the corner before it; -1: the start.
  struct Step {
    double length;
    int corner, parent;
    bool seen;  // whether it is known that the parent sees the corner
  };
  struct Open {
    double key;
    Step step;
  };
  struct Found {
    double length;
    int parent;
  };

  Point place(int corner) const { return sights_.corners()[corner].place; }
  Lattice at(int corner) const { return corner < 0 ? at_from_ : sights_.corners()[corner].at; }
  double length_of(int corner) const {
    const auto found = found_.find(corner);
    return found == found_.end() ? kFar : found->second.length;
  }
  bool seen(const Step& step) const { return step.seen || sights_.sees(at(step.parent), at(step.corner)); }

  void reach(const Step& step) {
    const double key = step.length + distance(place(step.corner), to_);
    if (key < bound_ && step.length < length_of(step.corner)) open_.push({key, step});
  }

  void arrive(const Step& step) {
    const auto rest = rest_.find(step.corner);
    if (rest == rest_.end() || step.length + rest->second >= length_) return;
    length_ = step.length + rest->second;
    last_ = step.corner;
    bound_ = std::min(bound_, length_);
  }

  void expand(const Step& step) {
    ++looks_;
    const Point here = place(step.corner);
    const Lattice coming = at(step.corner) - at(step.parent);
    for (const int next : sights_.onward(step.corner, coming, {here, to_, bound_ - step.length})) {
      reach({step.length + distance(here, place(next)), next, step.corner, !sights_.may_be_blocked()});
    }
  }

  std::vector<Point> way() const {
    if (length_ == kFar) return {};
    std::vector<Point> way{to_};
    for (int corner = last_; corner >= 0; corner = found_.at(corner).parent) way.push_back(place(corner));
    way.push_back(from_);
    std::reverse(way.begin(), way.end());
    return way;
  }

  const Sights& sights_;
  Point from_, to_;
  Lattice at_from_, at_to_;
  std::unordered_map<int, double> rest_;  // from the corners that see the goal to it
  std::unordered_map<int, Found> found_;
  Heap<Open> open_;
  double bound_ = kFar;   // no way that is longer is of use
  double length_ = kFar;  // of the best way found
  int last_ = -1;         // its last corner
  std::size_t looks_ = 0;
};

}  // namespace

CornerWay search_corners(const Sights& sights, Point from, Point to) { return CornerSearch(sights, from, to).run(); }

}  // namespace muster
