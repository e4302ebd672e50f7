"""Compiled inner loops of hierarchical merging over a graph of regions."""

# Types are inferred at compile time and array shapes are in the docstrings.
# mypy: allow-untyped-defs, allow-untyped-calls

import heapq

import numpy as np
from numba import njit


@njit(cache=True, error_model="numpy")
def _loss(weights, means, a, b):
    """Ward's: how much the weighted sum of squared deviations grows when a and b become one. 0 without weight."""
    total = weights[a] + weights[b]
    if total <= 0.0:
        return 0.0
    squared = 0.0
    for k in range(means.shape[1]):
        squared += (means[a, k] - means[b, k]) ** 2
    return weights[a] * weights[b] / total * squared


@njit(cache=True, error_model="numpy")
def _root(parent, node):
    while parent[node] != node:
        parent[node] = parent[parent[node]]
        node = parent[node]
    return node


@njit(cache=True, error_model="numpy")
def _link(pairs, n_nodes):
    """Half-edges as linked lists: head (n_nodes,), following (2k,), target (2k,)."""
    head = np.full(n_nodes, -1, np.int64)
    following = np.empty(2 * len(pairs), np.int64)
    target = np.empty(2 * len(pairs), np.int64)
    for e in range(len(pairs)):
        for side in range(2):
            node, h = pairs[e, side], 2 * e + side
            target[h], following[h] = pairs[e, 1 - side], head[node]
            head[node] = h
    return head, following, target


@njit(cache=True, error_model="numpy")
def _join_lists(first, second, node, head, following, target, parent, stamp):
    """Half-edges of first and second strung together for `node`, one for each distinct neighbour."""
    joined = -1
    for old in (first, second):
        h = head[old]
        while h >= 0:
            after = following[h]
            other = _root(parent, target[h])
            if other != node and stamp[other] != node:
                stamp[other] = node
                target[h], following[h] = other, joined
                joined = h
            h = after
    head[node] = joined


@njit(cache=True, error_model="numpy")
def merge_sequence(pairs, weights, features):
    """Merges neighbours, least loss first, until none are left: (q, 2) int64, the heavier of the two first.

    pairs (k, 2) int64; weights (m,) ≥ 0; features (m, d). Merge i makes node m + i. Ties go to the lower indices.
    """
    m = len(weights)
    weight, mean = np.zeros(2 * m), np.zeros((2 * m, features.shape[1]))
    weight[:m], mean[:m] = weights, features
    parent, stamp = np.arange(2 * m), np.full(2 * m, -1, np.int64)
    head, following, target = _link(pairs, 2 * m)
    heap = [(_loss(weight, mean, e[0], e[1]), e[0], e[1]) for e in pairs]
    heapq.heapify(heap)
    merges = np.empty((max(m - 1, 0), 2), np.int64)
    n = 0
    while len(heap) > 0:
        _, a, b = heapq.heappop(heap)
        if parent[a] != a or parent[b] != b:  # one of them has become part of another since
            continue
        node = m + n
        heavier, lighter = (a, b) if weight[a] >= weight[b] else (b, a)
        merges[n] = heavier, lighter
        n += 1
        parent[a] = parent[b] = node
        weight[node] = weight[a] + weight[b]
        share = weight[lighter] / weight[node] if weight[node] > 0.0 else 0.5
        mean[node] = mean[heavier] + share * (mean[lighter] - mean[heavier])
        _join_lists(a, b, node, head, following, target, parent, stamp)
        h = head[node]
        while h >= 0:
            heapq.heappush(heap, (_loss(weight, mean, node, target[h]), node, target[h]))
            h = following[h]
    return merges[:n]


@njit(cache=True, error_model="numpy")
def undo_merges(merges, m, roots, n_undone):
    """Label of each leaf, (m,) int64, after taking back the last `n_undone` merges.

    roots (c,): the nodes that nothing merged, labelled 0 … c − 1. Each merge taken back leaves its label to the first
    child and gives the next one to the second.
    """
    label = np.full(m + len(merges), -1, np.int64)
    for k in range(len(roots)):
        label[roots[k]] = k
    following = len(roots)
    for i in range(len(merges) - 1, -1, -1):
        inherited = label[m + i]
        label[merges[i, 0]] = inherited
        if len(merges) - i <= n_undone:
            label[merges[i, 1]] = following
            following += 1
        else:
            label[merges[i, 1]] = inherited
    return label[:m]
