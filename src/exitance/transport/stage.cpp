#include "exitance/transport/stage.hpp"

#include "exitance/base/error_share.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/mesh/adaptive.hpp"
#include "exitance/transport/body_surroundings.hpp"

namespace exitance {
namespace {

/// Returns the divisor of element edges for a room whose areas have this weight. The room then has as many elements as
/// it would have if it were the only one.
double finer_by(double weight) {
    return std::sqrt(std::max(1.0, weight));
}

double longest_extent(const ElementTree& tree, ElementId e) {
    const std::vector<Point> outline = tree.outline(e);
    double longest = 0;
    for (const Point& p : outline)
        for (const Point& q : outline) longest = std::max(longest, norm(p - q));
    return longest;
}

/// Splits elements that belong to smaller rooms to the element size of their room.
void cut_to_rooms(ElementTree& tree, const LightRooms& rooms, double edge) {
    constexpr double diagonal = 1.5;  // longest extent of an element over its edge; derived from sqrt(2), with a margin
    constexpr double coarsest =       // ratio of an element's area to wanted^2: a larger one belongs to several rooms
        64 * 64;
    std::vector<ElementId> open = tree.leaves();
    while (!open.empty()) {
        const ElementId e = open.back();
        open.pop_back();
        const double wanted = edge / finer_by(rooms.importance(tree, e));
        if (tree.area(e) > coarsest * wanted * wanted || longest_extent(tree, e) <= diagonal * wanted) continue;
        for (ElementId child : refine_element(tree, e)) open.push_back(child);
    }
}

}  // namespace

ElementTree Stage::make_elements(MeshSize size, const StopRequest* stop) const {
    std::vector<double> finer;
    for (std::size_t k = 0; k < pieces.size() && rooms.count() > 0; ++k)
        finer.push_back(finer_by(rooms.importance_of_piece(k)));
    ElementTree tree = make_mesh(pieces, concave, size, unlit, finer);
    std::vector<ElementId> leaves = tree.leaves();
    std::erase_if(leaves, [&](ElementId e) { return is_unlit(tree.region(e)); });
    // Among thousands of leaves or slats that intersect each other none matters on its own: small ones stay whole.
    if (is_crowd(leaves.size())) {
        const double small = small_area(leaves.size());
        std::erase_if(leaves, [&](ElementId e) { return tree.area(e) < small; });
    }
    cut_along_contacts(tree, leaves, contacts, stop);
    if (rooms.surroundings()) rooms.surroundings()->refine(tree, stop);
    if (rooms.count() > 0) cut_to_rooms(tree, rooms, size.edge);
    return tree;
}

bool Stage::is_crowd(std::size_t elements) const {
    return ErrorShare::is_crowd(elements, pieces.size(), rooms.multiplicity());
}

double Stage::small_area(std::size_t elements) const {
    return ErrorShare::small_area(area, elements, rooms.multiplicity());
}

void Stage::set_rooms(LightRooms found) {
    rooms = std::move(found);
    if (rooms.multiplicity() > 1) concave = find_concave_borders(scene, pieces, rooms.multiplicity());
}

double Stage::expected_reflections() const {
    double reflected = 0;
    for (const Piece& piece : pieces)
        if (!is_unlit(piece.region)) reflected += piece.patch.area() * mean(scene.material(piece.region).reflectance);
    return std::min(calibrated::largest_reflection_count, 1 / (1 - reflected / area));
}

}  // namespace exitance
