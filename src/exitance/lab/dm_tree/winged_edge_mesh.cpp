#include "exitance/lab/dm_tree/winged_edge_mesh.hpp"

#include <algorithm>

#include "exitance/base/check.hpp"

namespace exitance {

WingedEdgeMesh::WingedEdgeMesh(std::span<const Vec2> outline) {
    const auto n = static_cast<std::uint32_t>(outline.size());
    EXI_CHECK(n >= 3);
    for (std::uint32_t i = 0; i < n; ++i) {
        vertices_.push_back({outline[i], 0, i});
        Edge edge;
        edge.vertex = {i, (i + 1) % n};
        edge.face = {0, none};
        edge.next = {(i + 1) % n, (i + n - 1) % n};
        edge.before = {(i + n - 1) % n, (i + 1) % n};
        edges_.push_back(edge);
    }
    faces_.push_back({0});
}

std::vector<WingedEdgeMesh::Corner> WingedEdgeMesh::loop(std::uint32_t face) const {
    std::vector<Corner> out;
    const std::uint32_t first = faces_[face].edge;
    std::uint32_t edge = first;
    do {
        const std::size_t s = side(edge, face);
        out.push_back({edges_[edge].vertex[s], edge});
        edge = edges_[edge].next[s];
    } while (edge != first);
    return out;
}

void WingedEdgeMesh::link(std::uint32_t first, std::uint32_t second, std::uint32_t face) {
    edges_[first].next[side(first, face)] = second;
    edges_[second].before[side(second, face)] = first;
}

std::uint32_t WingedEdgeMesh::cut_edge(std::uint32_t e, const Vec2& at) {
    const auto m = static_cast<std::uint32_t>(vertices_.size());
    const auto added = static_cast<std::uint32_t>(edges_.size());
    vertices_.push_back({at, 0, added});
    const Edge old = edges_[e];
    edges_.push_back(old);
    edges_[added].vertex[0] = m;
    edges_[e].vertex[1] = m;
    vertices_[old.vertex[1]].edge = added;
    // On the left side the second half follows the first; on the right side it precedes it.
    for (std::size_t s = 0; s < 2; ++s) {
        const std::uint32_t face = old.face[s];
        if (s == 0) {
            edges_[e].next[0] = added, edges_[added].before[0] = e;
            const std::uint32_t after = old.next[0];
            edges_[after].before[side(after, face)] = added;
        } else {
            edges_[added].next[1] = e, edges_[e].before[1] = added;
            const std::uint32_t ahead = old.before[1];
            edges_[ahead].next[side(ahead, face)] = added;
        }
    }
    return m;
}

std::uint32_t WingedEdgeMesh::cut_face(std::uint32_t face, std::uint32_t a, std::uint32_t b) {
    const std::vector<Corner> corners = loop(face);
    const std::size_t n = corners.size();
    const auto place = [&](std::uint32_t v) {
        return static_cast<std::size_t>(
            std::find_if(corners.begin(), corners.end(), [&](const Corner& c) { return c.vertex == v; }) -
            corners.begin());
    };
    const std::size_t i = place(a), j = place(b);
    EXI_CHECK(i < n && j < n && i != j);
    const auto added = static_cast<std::uint32_t>(edges_.size());
    const auto other = static_cast<std::uint32_t>(faces_.size());
    Edge edge;
    edge.vertex = {a, b};
    edge.face = {other, face};
    edges_.push_back(edge);
    faces_.push_back({added});
    faces_[face].edge = added;
    for (std::size_t k = j; k != i; k = (k + 1) % n) edges_[corners[k].edge].face[side(corners[k].edge, face)] = other;
    link(added, corners[j].edge, other);
    link(corners[(i + n - 1) % n].edge, added, other);
    link(added, corners[i].edge, face);
    link(corners[(j + n - 1) % n].edge, added, face);
    return added;
}

}  // namespace exitance
