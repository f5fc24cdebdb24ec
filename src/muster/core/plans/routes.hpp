// Routes as Python gives and takes them.
#pragma once

#include <vector>

#include "plans/draft.hpp"

namespace muster {

using Routes = std::vector<std::vector<int>>;

// Throws std::invalid_argument if the routes are not those of the problem's robots, or a task stands twice.
Draft draft_from(const Problem& problem, const Routes& routes);
Routes routes_of(const Problem& problem, const Draft& draft);

}  // namespace muster
