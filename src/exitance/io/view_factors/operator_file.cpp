#include "exitance/io/view_factors/operator_file.hpp"

#include <utility>

#include "exitance/io/view_factors/factor_rows_file.hpp"
#include "exitance/io/view_factors/view_factor_file.hpp"

namespace exitance {
namespace {

constexpr std::int64_t operator_version = 1;  ///< Version of the format; raised if older programs cannot read the file.
const std::string group = "factor_operator";

/// Reads the tree, if its order contains every face exactly once.
FaceTree read_tree(Hdf5Reader& file, std::size_t faces) {
    const auto order = file.read<std::int32_t>(group + "/order", 1, faces);
    std::vector<std::uint8_t> named(faces);
    for (const std::int32_t j : order) {
        if (j < 0 || static_cast<std::size_t>(j) >= faces || named[static_cast<std::size_t>(j)]++) {
            file.fail(group + "/order", "does not name every face once");
            break;
        }
    }
    return file.failed() ? FaceTree() : FaceTree(std::vector<std::uint32_t>(order.begin(), order.end()));
}

Result<FactorOperator> read_operator(Hdf5Reader& file, const std::string& path) {
    if (const Result<void> known = check_file_version(file, group, operator_version, path); !known)
        return known.error();
    FactorOperator out;
    const std::size_t faces = file.read<double>(group + "/areas").size();
    if (!file.failed()) out.tree = read_tree(file, faces);
    if (!file.failed()) out.rows = read_factor_rows(file, group, out.tree.nodes());
    if (file.failed()) return file.error();
    return out;
}

}  // namespace

Result<void> write_factor_operator(const std::string& path, const FactorOperator& transport, const StopRequest& stop) {
    const Error stopped{ErrorCode::limit, "stopped while the operator was written", "", "allow more time"};
    if (stop.requested()) return stopped;
    const FaceTree& tree = transport.tree;
    Hdf5Writer file(path);
    file.make_group(group);
    file.set_attribute(group, "format", std::string_view("rows over faces and nodes of a tree"));
    file.set_attribute(group, "version", operator_version);
    file.set_attribute(group, "combined", static_cast<std::int32_t>(transport.rows.combined));
    file.set_attribute(group, "closure_defect", transport.closure_defect());
    write_factor_rows(file, group, transport.rows);
    const auto number = [](std::uint32_t value) { return static_cast<std::int32_t>(value); };
    file.write_rows<std::int32_t>(
        group + "/order", tree.size(), 1, {"1", "faces, from 0; those of a node are consecutive"},
        [&](std::size_t k, std::span<std::int32_t> row) { row[0] = number(tree.order()[k]); });
    file.write_rows<std::int32_t>(group + "/nodes", tree.nodes(), 2,
                                  {"1", "first place of each node in order, and the place after its last"},
                                  [&](std::size_t k, std::span<std::int32_t> row) {
                                      row[0] = number(tree.range(k).first), row[1] = number(tree.range(k).last);
                                  });
    if (stop.requested()) return stopped;
    return file.commit();
}

Result<FactorOperator> read_factor_operator(const std::string& path) {
    Result<Hdf5Reader> file = Hdf5Reader::open(path);
    if (!file) return file.error();
    return read_operator(*file, path);
}

Result<std::variant<SparseFactors, FactorOperator>> read_factors(const std::string& path) {
    using Either = std::variant<SparseFactors, FactorOperator>;
    Result<Hdf5Reader> file = Hdf5Reader::open(path);
    if (!file) return file.error();
    if (file->has(group + "/areas")) {
        Result<FactorOperator> transport = read_operator(*file, path);
        if (!transport) return transport.error();
        return Either(std::move(*transport));
    }
    Result<SparseFactors> table = read_view_factors(*file, path);
    if (!table) return table.error();
    return Either(std::move(*table));
}

}  // namespace exitance
