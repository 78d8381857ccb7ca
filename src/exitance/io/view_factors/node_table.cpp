#include "exitance/io/view_factors/node_table.hpp"

#include <fmt/format.h>

#include <map>

#include "exitance/base/words.hpp"
#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/io/scenes/view3d.hpp"
#include "exitance/view_factors/sparse_factors.hpp"

namespace exitance {
namespace {

/// Nodes by a key of every face.
template <class KeyOf>
FactorNodes nodes_by(const Scene& scene, const KeyOf& key_of) {
    FactorNodes nodes;
    std::map<std::string, std::uint32_t> known;
    for (const Surface& surface : scene.surfaces()) {
        const std::string& name = key_of(surface);
        const auto [at, is_new] = known.try_emplace(name, static_cast<std::uint32_t>(nodes.names.size()));
        if (is_new) nodes.names.push_back(name);
        nodes.row_of_face.push_back(at->second);
    }
    return nodes;
}

}  // namespace

FactorNodes nodes_by_group(const Scene& scene) {
    return nodes_by(scene, [&](const Surface& s) -> const std::string& { return scene.groups()[s.group]; });
}

FactorNodes nodes_by_material(const Scene& scene) {
    return nodes_by(scene, [&](const Surface& s) -> const std::string& { return scene.materials()[s.material].name; });
}

FactorNodes view3d_rows(const Scene& scene, const std::string& path) {
    FactorNodes nodes;
    nodes.masks = read_view3d_masks(path);
    for (const GroupId g : scene.groups().ids())
        if (scene.groups()[g] != view3d_obstructions) nodes.names.push_back(scene.groups()[g]);
    for (const Surface& surface : scene.surfaces())
        nodes.row_of_face.push_back(surface.group.value < nodes.names.size() ? surface.group.value : no_row);
    return nodes;
}

SparseFactors merge_nodes(const SparseFactors& table, const FactorNodes& nodes) {
    SparseFactors out = merge_rows(table, nodes.row_of_face, nodes.names.size());
    out.names = nodes.names;
    apply_masks(out, nodes.masks);
    return out;
}

void apply_masks(SparseFactors& table, std::span<const View3dMask> masks) {
    if (masks.empty()) return;
    const std::size_t n = table.size();
    std::vector<std::uint32_t> base_of(n, no_row);
    std::vector<double> covered(n);
    std::vector<std::map<std::uint32_t, double>> rows(n);
    for (const View3dMask& mask : masks) base_of[mask.row] = mask.base, covered[mask.base] += table.areas[mask.row];
    for (std::size_t i = 0; i < n; ++i) {
        if (base_of[i] != no_row) {
            rows[i][base_of[i]] = 1;
            continue;
        }
        const double open = covered[i] > 0 ? table.areas[i] / (table.areas[i] + covered[i]) : 1;
        for (std::size_t k = table.starts[i]; k < table.starts[i + 1]; ++k)
            if (base_of[table.columns[k]] == no_row) rows[i][table.columns[k]] = open * table.values[k];
        for (std::vector<double>* shares : {&table.sky, &table.back, &table.row_errors, &table.dropped})
            if (!shares->empty()) (*shares)[i] *= open;
    }
    for (const View3dMask& mask : masks) {
        rows[mask.base][mask.row] = table.areas[mask.row] / (table.areas[mask.base] + covered[mask.base]);
        for (std::vector<double>* shares : {&table.sky, &table.back, &table.row_errors, &table.dropped})
            if (!shares->empty()) (*shares)[mask.row] = 0;
    }
    table.starts = {0}, table.columns.clear(), table.values.clear();
    for (std::size_t i = 0; i < n; ++i) {
        table.areas[i] += covered[i], table.row_sums[i] = 0;
        for (const auto& [column, F] : rows[i])
            table.columns.push_back(column), table.values.push_back(F), table.row_sums[i] += F;
        table.starts.push_back(table.values.size());
    }
}

Result<FactorNodes> read_node_table(const std::string& path, std::size_t faces) {
    Result<LineReader> lines = LineReader::open(path);
    if (!lines) return lines.error();
    const std::string hint = "the columns are face,node";
    const auto header = lines->next_content();
    if (lines->failed()) return lines->read_error();
    if (!header) return lines->error("the table is empty", hint);
    const std::size_t middle = header->find(',');
    const std::string first(without_quotes(header->substr(0, middle)));
    const std::string second(middle == std::string_view::npos ? "" : without_quotes(header->substr(middle + 1)));
    const bool is_turned = first == "node" && second == "face";
    if (!is_turned && !(first == "face" && second == "node"))
        return lines->error(fmt::format("the header is '{}'", shown(*header)), hint);
    FactorNodes nodes;
    nodes.row_of_face.assign(faces, no_row);
    std::map<std::string, std::uint32_t> known;
    while (const auto line = lines->next_content()) {
        const std::size_t comma = is_turned ? line->rfind(',') : line->find(',');
        if (comma == std::string_view::npos) return lines->error("a line has one field only", hint);
        const std::string left(without_quotes(line->substr(0, comma))), right(without_quotes(line->substr(comma + 1)));
        const std::string &face = is_turned ? right : left, &node = is_turned ? left : right;
        const std::optional<long long> number = parse_integer(face);
        if (!number || *number < 1 || *number > static_cast<long long>(faces))
            return lines->error(fmt::format("there is no face '{}'", shown(face)),
                                fmt::format("faces are numbered from 1 to {}", faces));
        const bool is_quoted = line->find('"') != std::string_view::npos;
        if (!is_quoted && node.find(',') != std::string::npos)
            return lines->error("a line has more than two fields", hint + "; put a name with a comma in quotes");
        if (node.empty()) return lines->error("the name of the node is missing", hint);
        std::uint32_t& row = nodes.row_of_face[static_cast<std::size_t>(*number - 1)];
        if (row != no_row) return lines->error(fmt::format("face {} has a node already", *number), "name it once");
        const auto [at, is_new] = known.try_emplace(node, static_cast<std::uint32_t>(nodes.names.size()));
        if (is_new) nodes.names.push_back(node);
        row = at->second;
    }
    if (lines->failed()) return lines->read_error();
    if (nodes.names.empty()) return lines->error("the table has no faces", hint);
    return nodes;
}

std::vector<std::string> face_names(const Scene& scene) {
    std::vector<std::size_t> count(scene.groups().size()), next(scene.groups().size());
    for (const Surface& surface : scene.surfaces()) ++count[surface.group.value];
    std::vector<std::string> names;
    for (const Surface& surface : scene.surfaces()) {
        const std::string& group = scene.groups()[surface.group];
        const std::size_t number = ++next[surface.group.value];
        names.push_back(count[surface.group.value] == 1 ? group : fmt::format("{} {}", group, number));
    }
    return names;
}

}  // namespace exitance
