"""Compiled inner loops over the face graph: building it, Dijkstra, many sources at once, farthest-point sampling.

A graph is three arrays: `starts` (nodes + 1,) int32, `neighbours` int32 and `lengths` float32 (compressed rows). The
first m nodes are faces. Distances are float32; every kernel returns the least sum over paths, added from the source
outwards, so Dijkstra and the sweeps agree bit for bit and nothing depends on the number of threads.
"""

# Types are inferred at compile time and array shapes are in the docstrings.
# mypy: allow-untyped-defs, allow-untyped-calls

import numpy as np
from numba import njit, prange

LANES = 32
"""Distance fields advanced together by `geodesic_batches`: the inner loop over them compiles to vector instructions."""


@njit(cache=True, error_model="numpy")
def _gather_neighbours(face, faces, vertex_starts, vertex_faces, is_hub, stamp, row):
    """Distinct faces around `face` through its ordinary vertices, into `row`; returns their number."""
    n = 0
    stamp[face] = face
    for k in range(3):
        vertex = faces[face, k]
        if is_hub[vertex]:
            continue
        for e in range(vertex_starts[vertex], vertex_starts[vertex + 1]):
            other = vertex_faces[e]
            if stamp[other] != face:
                stamp[other] = face
                row[n] = other
                n += 1
    return n


@njit(cache=True, error_model="numpy")
def _distance(a, b):
    return np.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)


@njit(cache=True, error_model="numpy")
def build_face_graph(faces, vertices, centroids, vertex_starts, vertex_faces, hubs, hub_valence):
    """Compressed rows of the graph described in `partwise.geometry.geodesics.FaceGraph`."""
    m, n_vertices = len(faces), len(vertices)
    is_hub = np.zeros(n_vertices, np.bool_)
    for h in hubs:
        is_hub[h] = True
    stamp = np.full(m, -1, np.int64)
    row = np.empty(3 * hub_valence, np.int64)
    starts = np.zeros(m + len(hubs) + 1, np.int32)
    for f in range(m):
        n = _gather_neighbours(f, faces, vertex_starts, vertex_faces, is_hub, stamp, row)
        for k in range(3):
            n += is_hub[faces[f, k]]
        starts[f + 1] = starts[f] + n
    for i in range(len(hubs)):
        starts[m + i + 1] = starts[m + i] + vertex_starts[hubs[i] + 1] - vertex_starts[hubs[i]]
    neighbours = np.empty(starts[-1], np.int32)
    lengths = np.empty(starts[-1], np.float32)
    hub_node = np.full(n_vertices, -1, np.int64)
    for i in range(len(hubs)):
        hub_node[hubs[i]] = m + i
    stamp[:] = -1
    for f in range(m):
        n = _gather_neighbours(f, faces, vertex_starts, vertex_faces, is_hub, stamp, row)
        e = starts[f]
        for other in np.sort(row[:n]):
            neighbours[e], lengths[e] = other, _distance(centroids[f], centroids[other])
            e += 1
        for k in range(3):
            vertex = faces[f, k]
            if is_hub[vertex]:
                neighbours[e], lengths[e] = hub_node[vertex], _distance(centroids[f], vertices[vertex])
                e += 1
    for i in range(len(hubs)):
        e = starts[m + i]
        for f in vertex_faces[vertex_starts[hubs[i]] : vertex_starts[hubs[i] + 1]]:
            neighbours[e], lengths[e] = f, _distance(centroids[f], vertices[hubs[i]])
            e += 1
    return starts, neighbours, lengths


@njit(cache=True, error_model="numpy")
def _push(keys, nodes, size, key, node):
    i = size
    while i > 0:
        parent = (i - 1) >> 1
        if keys[parent] <= key:
            break
        keys[i], nodes[i] = keys[parent], nodes[parent]
        i = parent
    keys[i], nodes[i] = key, node
    return size + 1


@njit(cache=True, error_model="numpy")
def _drop_top(keys, nodes, size):
    size -= 1
    key, node = keys[size], nodes[size]
    i = 0
    while True:
        child = 2 * i + 1
        if child >= size:
            break
        if child + 1 < size and keys[child + 1] < keys[child]:
            child += 1
        if keys[child] >= key:
            break
        keys[i], nodes[i] = keys[child], nodes[child]
        i = child
    keys[i], nodes[i] = key, node
    return size


@njit(cache=True, error_model="numpy")
def _settle(starts, neighbours, lengths, distance, order, keys, nodes, size, limit):
    """Dijkstra from what is in the heap; lowers `distance`, fills `order` with the settled nodes, returns how many."""
    n_settled = 0
    while size > 0:
        reached, node = keys[0], nodes[0]
        size = _drop_top(keys, nodes, size)
        if reached > distance[node]:
            continue
        order[n_settled] = node
        n_settled += 1
        for e in range(starts[node], starts[node + 1]):
            other = neighbours[e]
            through = reached + lengths[e]
            if through < distance[other] and through <= limit:
                distance[other] = through
                size = _push(keys, nodes, size, through, other)
    return n_settled


@njit(cache=True, parallel=True, error_model="numpy")
def geodesics_from(starts, neighbours, lengths, sources, limit, n_faces):
    """One Dijkstra a source, in parallel: (k, n_faces) float32, infinity beyond `limit` or out of reach."""
    n_nodes = len(starts) - 1
    result = np.empty((len(sources), n_faces), np.float32)
    for s in prange(len(sources)):
        distance = np.full(n_nodes, np.float32(np.inf))
        order = np.empty(n_nodes, np.int32)
        keys = np.empty(len(neighbours) + 1, np.float32)
        nodes = np.empty(len(neighbours) + 1, np.int32)
        distance[sources[s]] = 0
        size = _push(keys, nodes, 0, np.float32(0), np.int32(sources[s]))
        _settle(starts, neighbours, lengths, distance, order, keys, nodes, size, limit)
        result[s] = distance[:n_faces]
    return result


@njit(cache=True, error_model="numpy")
def _central_order(starts, neighbours, lengths, targets, target_starts, batch, order):
    """Nodes in order of distance from the middle source of each component in this batch; returns how many."""
    n_nodes = len(starts) - 1
    distance = np.full(n_nodes, np.float32(np.inf))
    keys = np.empty(len(neighbours) + len(target_starts), np.float32)
    nodes = np.empty(len(neighbours) + len(target_starts), np.int32)
    size = 0
    for c in range(len(target_starts) - 1):
        first = target_starts[c] + batch * LANES
        last = min(first + LANES, target_starts[c + 1])
        if first < last:
            source = targets[(first + last) // 2]
            distance[source] = 0
            size = _push(keys, nodes, size, np.float32(0), np.int32(source))
    return _settle(starts, neighbours, lengths, distance, order, keys, nodes, size, np.float32(np.inf))


@njit(cache=True, error_model="numpy")
def _sweep(starts, neighbours, lengths, order, position, is_changed, distance):
    """Relaxes changed nodes in `order`, then in reverse, and so on until nothing changes."""
    forward, n_left = True, 1
    while n_left > 0:
        n_left = 0
        for step in range(len(order)):
            at = step if forward else len(order) - 1 - step
            node = order[at]
            if is_changed[node] == 0:
                continue
            is_changed[node] = 0
            for e in range(starts[node], starts[node + 1]):
                other, length = neighbours[e], lengths[e]
                lowered = np.int32(0)
                for lane in range(LANES):
                    through = distance[node, lane] + length
                    known = distance[other, lane]
                    lowered |= np.int32(through < known)
                    distance[other, lane] = through if through < known else known
                if lowered:
                    is_changed[other] = 1
                    n_left += (position[other] < at) == forward
        forward = not forward


@njit(cache=True, parallel=True, error_model="numpy")
def geodesic_batches(starts, neighbours, lengths, targets, target_starts, batches, out):
    """Fields of LANES targets at once: out[b, node, lane] for the target at target_starts[c] + LANES·batches[b] + lane.

    c is the node's component, so that one lane serves one target of every component. Lanes without a target stay
    infinite. Targets of one batch should lie near each other: their wavefronts then pass the nodes in much the same
    order, the order of one Dijkstra from their middle, and about three relaxations a node replace LANES heaps.
    """
    n_nodes = len(starts) - 1
    for b in prange(len(batches)):
        order = np.empty(n_nodes, np.int32)
        n_reached = _central_order(starts, neighbours, lengths, targets, target_starts, batches[b], order)
        position = np.empty(n_nodes, np.int32)
        for at in range(n_reached):
            position[order[at]] = at
        is_changed = np.zeros(n_nodes, np.uint8)
        distance = out[b]
        distance[:] = np.inf
        for c in range(len(target_starts) - 1):
            first = target_starts[c] + batches[b] * LANES
            for t in range(first, min(first + LANES, target_starts[c + 1])):
                distance[targets[t], t - first] = 0
                is_changed[targets[t]] = 1
        _sweep(starts, neighbours, lengths, order[:n_reached], position, is_changed, distance)


@njit(cache=True, error_model="numpy")
def farthest_points(starts, neighbours, lengths, candidates, candidate_starts, n_wanted):
    """Farthest-point sampling within each component: (targets, their number per component, nearest target per node).

    candidates[candidate_starts[c] : candidate_starts[c + 1]] may be chosen in component c, the first one first. Each
    step only visits the nodes that come to lie nearer to the new target than to all before it.
    """
    n_nodes = len(starts) - 1
    distance = np.full(n_nodes, np.float32(np.inf))
    owner = np.full(n_nodes, -1, np.int64)
    order = np.empty(n_nodes, np.int32)
    keys = np.empty(len(neighbours) + 1, np.float32)
    nodes = np.empty(len(neighbours) + 1, np.int32)
    targets = np.empty(len(candidates), np.int64)
    is_chosen = np.zeros(n_nodes, np.bool_)
    n_chosen = np.zeros(len(candidate_starts) - 1, np.int64)
    n_targets = 0
    for c in range(len(n_chosen)):
        own = candidates[candidate_starts[c] : candidate_starts[c + 1]]
        while n_chosen[c] < min(n_wanted, len(own)):
            target, farthest = own[0], np.float32(-1)
            for candidate in own:
                if distance[candidate] > farthest and not is_chosen[candidate]:
                    target, farthest = candidate, distance[candidate]
            is_chosen[target] = True
            distance[target] = 0
            size = _push(keys, nodes, 0, np.float32(0), np.int32(target))
            n = _settle(starts, neighbours, lengths, distance, order, keys, nodes, size, np.float32(np.inf))
            for at in range(n):
                owner[order[at]] = n_targets
            targets[n_targets] = target
            n_targets += 1
            n_chosen[c] += 1
    return targets[:n_targets], n_chosen, owner
