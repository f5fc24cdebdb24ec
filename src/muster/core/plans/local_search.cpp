#include "plans/local_search.hpp"

#include <algorithm>

#include "plans/or_opt.hpp"
#include "plans/part_exchange.hpp"
#include "plans/swap_tasks.hpp"
#include "plans/tail_exchange.hpp"
#include "plans/trade_tasks.hpp"
#include "plans/two_opt.hpp"

namespace muster {

namespace {

constexpr int kTriedBeside = 10;     // tasks beside which a task is tried
constexpr double kLeastGain = 1e-9;  // in the usual way: less may be rounding

constexpr double kForbidding = 1e6;  // of a weight left out, in what all routes cost: no gain makes up for it

template <class Kind>
void add(std::vector<std::unique_ptr<Move>>& moves, Surroundings& around) {
  if (Kind::supports(around.problem)) moves.push_back(std::make_unique<Kind>(around));
}

}  // namespace

Surroundings::Surroundings(const Problem& for_problem, const Neighbours& neighbours, Team& of_team, TeamCost& of_cost)
    : problem(for_problem), team(of_team), cost(of_cost), neighbours_(neighbours), is_awake_(for_problem.tasks(), 0) {
  double ways = 0.0;
  for (int robot = 0; robot < problem.robots(); ++robot) ways += team.usage(robot);
  least_gain_ = kLeastGain * ways / std::max(1, problem.tasks());
}

std::span<const int> Surroundings::near(int task) const {
  const auto all = neighbours_.of(task);
  return all.first(std::min<std::size_t>(all.size(), kTriedBeside));
}

void Surroundings::wake(int place) {
  if (!team.is_task(place) || is_awake_[place]) return;
  is_awake_[place] = 1;
  awake_.push_back(place);
}

int Surroundings::next_awake() {
  while (!awake_.empty()) {
    const int task = awake_.back();
    awake_.pop_back();
    is_awake_[task] = 0;
    if (team.present(task) && !team.fixed(task)) return task;
  }
  return Team::kAbsent;
}

LocalSearch::LocalSearch(const Problem& problem, const Neighbours& neighbours, Team& team, TeamCost& cost)
    : around_(problem, neighbours, team, cost) {
  add<TwoOpt>(moves_, around_);
  add<OrOpt>(moves_, around_);
  add<SwapTasks>(moves_, around_);
  add<TailExchange>(moves_, around_);
  add<PartExchange>(moves_, around_);
  add<TradeTasks>(moves_, around_);
}

void LocalSearch::improve() {
  around_.cost.look();
  for (int task = around_.next_awake(); task != Team::kAbsent; task = around_.next_awake()) {
    for (std::size_t k = 0; k < moves_.size() && around_.team.present(task);) {
      k = moves_[k]->improve(task) ? 0 : k + 1;
    }
  }
}

Routes improved(const Problem& problem, const Routes& routes) {
  const Neighbours neighbours(problem, kTriedBeside, 1);
  Team team(problem, routes);
  TeamCost cost(problem, team);
  LocalSearch search(problem, neighbours, team, cost);
  search.weigh(kForbidding * (1.0 + cost.cost()));
  for (int task = 0; task < problem.tasks(); ++task) search.wake(task);
  search.improve();
  return team.routes();
}

}  // namespace muster
