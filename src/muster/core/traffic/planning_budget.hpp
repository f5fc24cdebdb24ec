// How much a plan of traffic may cost: expansions, which are the same on every machine, or seconds.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>

namespace muster {

class PlanningBudget {
 public:
  explicit PlanningBudget(std::int64_t expansions = std::numeric_limits<std::int64_t>::max(),
                          double seconds = std::numeric_limits<double>::infinity())
      : left_(expansions), seconds_(seconds) {}

  void spend(std::int64_t expansions) { left_ -= expansions; }
  bool is_spent() const {
    return left_ <= 0 || std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count() >= seconds_;
  }

 private:
  std::int64_t left_;
  double seconds_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

}  // namespace muster
