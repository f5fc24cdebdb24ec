// A queue in buckets: [dial1969].
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace muster {

// Items by rising key, those of one bucket in no order. A search that takes up again what got a shorter length after it
// was expanded is exact all the same.
class Buckets {
 public:
  // No key is further than `span` above the least one.
  Buckets(double width, double span) : width_(width), ring_(static_cast<std::size_t>(span / width) + 3) {}

  bool empty() const { return size_ == 0; }
  void clear() {
    for (auto& bucket : ring_) bucket.clear();
    current_ = size_ = 0;
  }
  // A key less than those of the current bucket, by rounding, belongs there.
  void push(double key, int item) {
    bucket(std::max(current_, static_cast<std::size_t>(key / width_))).push_back(item);
    ++size_;
  }
  // The lower end of the first bucket with an item, of which there must be one.
  double least() {
    while (bucket(current_).empty()) ++current_;
    return static_cast<double>(current_) * width_;
  }
  // Its items; what is pushed there from now on is for the next call.
  void take(std::vector<int>& items) {
    least();
    items.clear();
    items.swap(bucket(current_));
    size_ -= items.size();
  }

 private:
  std::vector<int>& bucket(std::size_t number) { return ring_[number % ring_.size()]; }

  double width_;
  std::vector<std::vector<int>> ring_;
  std::size_t current_ = 0;  // as if there were no ring
  std::size_t size_ = 0;
};

}  // namespace muster
