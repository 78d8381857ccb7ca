#include "exitance/io/export/export_links.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>

#include "exitance/io/export/export_links_glb.hpp"
#include "exitance/io/files/atomic_file.hpp"

namespace exitance {
namespace {

/// Parses comma-separated numbers; empty if `text` is anything else.
std::optional<std::vector<double>> numbers_in(std::string_view text) {
    std::vector<double> out;
    for (;;) {
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out.emplace_back());
        if (error != std::errc()) return {};
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        if (text.empty()) return out;
        if (text.front() != ',') return {};
        text.remove_prefix(1);
    }
}

Point middle(const ElementTree& tree, ElementId e) {
    return tree.patch(e).at(tree.centre(e));
}

std::size_t level(const ElementTree& tree, ElementId e) {
    std::size_t out = 0;
    while (!(e = tree.parent(e)).is_none()) ++out;
    return out;
}

/// The elements that contain the surface point nearest to `p`, from the root to the leaf.
std::vector<ElementId> path_to(const ElementTree& tree, const Point& p) {
    ElementTree::Place best;
    double least = HUGE_VAL;
    for (ElementId root : tree.roots()) {
        const Patch& patch = tree.patch(root);
        const Vec2 uv = into_shape(patch.coordinates(p), patch.shape);
        const double distance = norm(patch.at(uv) - p);
        if (distance < least) least = distance, best = {root, uv};
    }
    std::vector<ElementId> out;
    for (ElementId e = tree.leaf_at(best.element, best.uv).element; !e.is_none(); e = tree.parent(e)) out.push_back(e);
    std::reverse(out.begin(), out.end());
    return out;
}

/// The receivers that `which` selects.
Result<std::vector<ElementId>> receivers(const ElementTree& tree, const std::string& which) {
    const auto given = numbers_in(which);
    if (given && given->size() == 3) return path_to(tree, {(*given)[0], (*given)[1], (*given)[2]});
    if (!given || given->size() != 1 || (*given)[0] != std::floor((*given)[0]) || (*given)[0] < 0)
        return Error{ErrorCode::usage, fmt::format("'{}' is neither an element's number nor x,y,z", which), "--links",
                     ""};
    if ((*given)[0] >= static_cast<double>(tree.size()))
        return Error{ErrorCode::usage,
                     fmt::format("there is no element {}; the last one is {}", which, tree.size() - 1), "--links", ""};
    return std::vector<ElementId>{ElementId(static_cast<std::size_t>((*given)[0]))};
}

std::string as_table(const ElementTree& tree, std::span<const KeptLink> links) {
    std::string out =
        "receiver,source,receiver_region,source_region,receiver_level,source_level,form_factor,receiver_area,"
        "source_area,receiver_x,receiver_y,receiver_z,source_x,source_y,source_z\n";
    for (const auto& [p, q, F] : links) {
        const Point x = middle(tree, p), y = middle(tree, q);
        fmt::format_to(std::back_inserter(out), "{},{},{},{},{},{},{:.6g},{:.10g},{:.10g}", p.value, q.value,
                       tree.region(p).value, tree.region(q).value, level(tree, p), level(tree, q), F, tree.area(p),
                       tree.area(q));
        for (double v : {x.x, x.y, x.z, y.x, y.y, y.z}) fmt::format_to(std::back_inserter(out), ",{:.10g}", v);
        out += '\n';
    }
    return out;
}

/// The sources of the links, each once.
std::vector<ElementId> sources_of(std::span<const KeptLink> links) {
    std::vector<ElementId> out;
    for (const KeptLink& link : links) out.push_back(link.source);
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

/// Formats the elements as polygons, each once, and the links as lines.
std::string as_lines(const ElementTree& tree, std::span<const ElementId> path, std::span<const KeptLink> links) {
    std::string out = "# Links of a hierarchy; metres\n";
    std::size_t vertices = 0;
    const auto vertex = [&](const Point& p) {
        fmt::format_to(std::back_inserter(out), "v {:.10g} {:.10g} {:.10g}\n", p.x, p.y, p.z);
        return ++vertices;
    };
    const auto polygon = [&](const char* kind, ElementId e) {
        fmt::format_to(std::back_inserter(out), "o {}_{}\n", kind, e.value);
        std::string face = "f";
        for (const Point& p : tree.outline(e)) face += fmt::format(" {}", vertex(p));
        out += face + "\n";
    };
    for (ElementId e : path) polygon("receiver", e);
    for (ElementId e : sources_of(links)) polygon("source", e);
    out += "o links\n";
    for (const KeptLink& link : links) {
        const std::size_t from = vertex(middle(tree, link.source)), to = vertex(middle(tree, link.receiver));
        out += fmt::format("l {} {}\n", from, to);
    }
    return out;
}

}  // namespace

Result<void> export_links(const Solution& solution, const std::string& which, const std::string& path) {
    const ElementTree& tree = solution.links.elements.tree;
    if (solution.links.links.empty())
        return Error{ErrorCode::bad_input, "the solution holds no links", "",
                     "solve with --method hierarchical or wavelet and --keep-links"};
    const Result<std::vector<ElementId>> to = receivers(tree, which);
    if (!to) return to.error();
    std::vector<KeptLink> chosen;
    for (const KeptLink& link : solution.links.links)
        if (std::find(to->begin(), to->end(), link.receiver) != to->end()) chosen.push_back(link);
    if (path.ends_with(".csv")) return write_file(path, as_table(tree, chosen));
    if (path.ends_with(".obj")) return write_file(path, as_lines(tree, *to, chosen));
    if (path.ends_with(".glb")) return write_links_glb(tree, *to, sources_of(chosen), chosen, path);
    return Error{ErrorCode::usage, "the ending of " + path + " is not that of a known format of links", path,
                 "known endings: .csv, .obj, .glb"};
}

}  // namespace exitance
