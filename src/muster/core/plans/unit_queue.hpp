// A queue of units by their labels.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace muster {

// Units in the order of labels, which lie between 0 and 1 and are spread over it: as many buckets as units, each a list
// with one unit or few, and a bit for each that has any.
class UnitQueue {
 public:
  enum class Order { rising, falling };

  UnitQueue(std::size_t units, Order order)
      : sign_(order == Order::rising ? 1.0 : -1.0),
        first_of_(units + 1, kNone),
        filled_(first_of_.size() / 64 + 1),
        next_(units, kAway),
        key_(units) {}

  bool empty() const { return size_ == 0; }
  bool has(int unit) const { return next_[unit] != kAway; }

  // A unit that is there already stays as it is.
  void push(double label, int unit) {
    if (has(unit)) return;
    const std::size_t bucket = bucket_of(label);
    key_[unit] = sign_ * label;
    next_[unit] = first_of_[bucket];
    first_of_[bucket] = unit;
    filled_[bucket / 64] |= std::uint64_t{1} << bucket % 64;
    word_ = std::min(word_, bucket / 64);
    ++size_;
  }

  // The unit that comes first, of which there must be one.
  int pop() {
    const std::size_t bucket = first_bucket();
    int* least = &first_of_[bucket];
    for (int* other = &next_[*least]; *other != kNone; other = &next_[*other]) {
      if (key_[*other] < key_[*least]) least = other;
    }
    const int unit = *least;
    *least = next_[unit];
    next_[unit] = kAway;
    if (first_of_[bucket] == kNone) filled_[bucket / 64] &= ~(std::uint64_t{1} << bucket % 64);
    --size_;
    return unit;
  }

  void clear() {
    while (!empty()) pop();
  }

 private:
  static constexpr int kNone = -1, kAway = -2;

  std::size_t bucket_of(double label) const {
    const double share = sign_ > 0.0 ? label : 1.0 - label;
    return static_cast<std::size_t>(share * static_cast<double>(key_.size()));
  }
  std::size_t first_bucket() {
    while (filled_[word_] == 0) ++word_;
    return 64 * word_ + static_cast<std::size_t>(std::countr_zero(filled_[word_]));
  }

  double sign_;
  std::vector<int> first_of_;  // by bucket
  std::vector<std::uint64_t> filled_;
  std::vector<int> next_;  // by unit, in the list of its bucket
  std::vector<double> key_;
  std::size_t word_ = 0;  // no bucket of a word before it is filled
  std::size_t size_ = 0;
};

}  // namespace muster
