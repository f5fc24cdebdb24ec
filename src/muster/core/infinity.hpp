// Infinite bounds, shared by all files of the core.
#pragma once

#include <limits>

namespace muster {

inline constexpr double kNever = std::numeric_limits<double>::infinity();  // a time later than all others
inline constexpr double kFar = std::numeric_limits<double>::infinity();    // a length greater than all others

}  // namespace muster
