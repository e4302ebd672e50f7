"""How many actors with how many threads, whatever the number of shapes and nodes."""

import socket
from collections.abc import Iterator

import pytest
import ray

from partwise_workers.cluster import (
    THREAD_VARIABLES,
    Cores,
    Crew,
    cores,
    is_node_lost,
    require_listener,
    thread_environment,
)

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


@pytest.fixture
def listener() -> Iterator[socket.socket]:
    with socket.create_server(("127.0.0.1", 0)) as server:
        yield server


@pytest.mark.parametrize("prefix", ["", "ray://"])
def test_an_address_where_somebody_listens_is_tried(listener: socket.socket, prefix: str) -> None:
    require_listener(f"{prefix}127.0.0.1:{listener.getsockname()[1]}")


@pytest.mark.parametrize("prefix", ["", "ray://"])
def test_an_address_where_nobody_listens_is_refused_at_once(listener: socket.socket, prefix: str) -> None:
    port = listener.getsockname()[1]
    listener.close()
    with pytest.raises(OSError, match="refused"):
        require_listener(f"{prefix}127.0.0.1:{port}")


@pytest.mark.parametrize("address", ["auto", "local"])
def test_rays_own_words_for_addresses_are_left_to_it(address: str) -> None:
    require_listener(address)


@pytest.mark.usefixtures("local_ray")
def test_cores_are_those_of_the_connected_ray() -> None:
    assert cores() == Cores(2, 2, 2)


@pytest.mark.usefixtures("local_ray")
def test_a_node_that_is_there_is_not_lost() -> None:
    assert not is_node_lost(ray.get_runtime_context().get_node_id())


@pytest.mark.usefixtures("local_ray")
def test_a_node_that_ray_does_not_list_as_alive_is_lost() -> None:
    assert is_node_lost("ab" * 28)
