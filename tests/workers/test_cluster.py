"""How many actors with how many threads, whatever the number of shapes and nodes."""

import pytest

from partwise_workers.cluster import THREAD_VARIABLES, Cores, Crew, cores, thread_environment

WORKSTATION = Cores(total=16, largest_node=16, smallest_node=16)
CLUSTER = Cores(total=64, largest_node=8, smallest_node=4)


def test_many_shapes_get_one_actor_a_core() -> None:
    assert Crew.of(WORKSTATION, n_shapes=1000, n_wanted=0) == Crew(16, 1)


def test_few_shapes_share_the_cores_as_threads() -> None:
    assert Crew.of(WORKSTATION, n_shapes=5, n_wanted=0) == Crew(5, 3)


def test_an_actor_never_has_more_threads_than_the_smallest_node_has_cores() -> None:
    assert Crew.of(CLUSTER, n_shapes=2, n_wanted=0) == Crew(2, 4)


def test_actors_that_the_user_asks_for_have_one_thread_each() -> None:
    assert Crew.of(WORKSTATION, n_shapes=1000, n_wanted=1) == Crew(1, 1)


def test_no_more_actors_than_shapes() -> None:
    assert Crew.of(WORKSTATION, n_shapes=3, n_wanted=8) == Crew(3, 1)


def test_without_a_shape_there_is_still_one_actor() -> None:
    assert Crew.of(WORKSTATION, n_shapes=0, n_wanted=0).n_actors == 1


@pytest.mark.parametrize("variable", THREAD_VARIABLES)
def test_every_numerical_library_is_told_its_threads(variable: str) -> None:
    assert thread_environment(3)[variable] == "3"


@pytest.mark.usefixtures("local_ray")
def test_cores_are_those_of_the_connected_ray() -> None:
    assert cores() == Cores(2, 2, 2)
