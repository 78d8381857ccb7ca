#include <fmt/format.h>

#include <algorithm>

#include "exitance/io/export/export_formats.hpp"
#include "exitance/io/files/atomic_file.hpp"

namespace exitance {
namespace {

const char* name_of(CurveCause cause) {
    switch (cause) {
        case CurveCause::contact:
            return "contact";
        case CurveCause::vertex_edge:
            return "VE";
        case CurveCause::edge_vertex:
            return "EV";
        case CurveCause::blocker_edge:
            return "NEV";
        case CurveCause::three_edges:
            return "EEE";
    }
    return "";
}

}  // namespace

Result<void> write_curves(const Solution& solution, const std::string& path) {
    if (solution.discontinuity.empty())
        return Error{ErrorCode::usage, "the solution holds no discontinuity curves to write to " + path, path,
                     "solve it with --method discontinuity"};
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    file->write("surface,x0,y0,z0,x1,y1,z1,order,cause,source\n");
    const auto face_of = [&](RegionId r) { return solution.scene.regions()[r].surfaces.front().value; };
    for (const DiscontinuityCurve& c : solution.discontinuity.curves)
        file->write(fmt::format("{},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},D{},{},{}\n", face_of(c.region),
                                c.a.x, c.a.y, c.a.z, c.b.x, c.b.y, c.b.z,
                                static_cast<int>(std::min(c.order, CurveOrder::d2)) - 1, name_of(c.cause),
                                c.source.is_none() ? std::string() : std::to_string(face_of(c.source))));
    return file->commit();
}

}  // namespace exitance
