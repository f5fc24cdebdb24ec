"""Messages of all kinds, for Hypothesis."""

from hypothesis import strategies as st

from muster_team.knowledge.messages import FACTS, Claim, Declaration, Fact, Heartbeat, Message, RoundBids, Sold, Stage

ROBOTS = ("r_0", "r_1", "r_2", "scout")
TASKS = ("t_0", "t_1", "t_2", "t_3", "gate")

robots = st.sampled_from(ROBOTS) | st.text(max_size=5)
tasks = st.sampled_from(TASKS) | st.text(max_size=5)
counts = st.integers(0, 40) | st.integers(0, 2**60)
prices = st.floats(allow_nan=False)


def several(values):
    return st.lists(values, max_size=4).map(tuple)


claims = st.builds(Claim, tasks, prices, counts, st.booleans())
facts = st.builds(Fact, tasks, robots, st.sampled_from(FACTS), counts, st.binary(max_size=8))
declarations = st.builds(
    Declaration,
    robots,
    counts,
    counts,
    several(robots),
    several(claims),
    several(facts),
    rounds=counts,
    incarnations=several(st.just(-1) | counts),
    knows=st.booleans(),
)
bids = st.builds(RoundBids, robots, counts, several(st.tuples(tasks, prices)))
stages = st.builds(Stage, counts, st.binary(max_size=8), counts, st.booleans())
messages = st.builds(
    Message,
    robots,
    counts,
    counts,
    stages,
    declarations=several(declarations),
    bids=several(bids),
    sales=several(st.builds(Sold, robots, tasks, prices, several(st.tuples(robots, tasks)))),
    sales_from=counts,
    lacks=several(robots),
    heartbeats=several(st.builds(Heartbeat, robots, counts, counts)),
    agreed=several(robots),
    facts=several(facts),
    known=counts,
    unheard=several(robots),
)
