#include "exitance/view_factors/near_faces.hpp"

#include <gtest/gtest.h>

#include "exitance/samples/generate.hpp"
#include "exitance/view_factors/row_scene.hpp"

namespace exitance {
namespace {

/// A face that is left out would be a hole in the list of candidates of a row.
TEST(NearFaces, NoFaceAboveTheLimitIsLeftOut) {
    const Scene scene = *make_scene(*generate_scene("complex", {{"m", "12"}})).scene;
    const RowScene ready(scene, StopRequest());
    const double negligible = 1e-3;
    std::size_t visits = 0, within = 0;
    for (std::size_t i = 0; i < ready.faces.size(); i += 7) {
        const double reach = ready.radii[i];
        std::vector<int> visited(ready.faces.size());
        ready.near.visit(ready.middles[i], reach, negligible, [&](std::uint32_t j) { ++visited[j], ++visits; });
        for (std::size_t j = 0; j < ready.faces.size(); ++j) {
            const double d = norm(ready.middles[j] - ready.middles[i]);
            const bool matters = ready.faces[j].area >= pi * d * d * negligible || d <= 2 * (reach + ready.radii[j]);
            within += matters;
            EXPECT_LE(visited[j], 1);
            if (matters) {
                EXPECT_EQ(visited[j], 1) << i << " " << j;
            }
        }
    }
    EXPECT_GT(within, 100u);
    EXPECT_LT(visits, 4 * within);  // boxes around balls, and sizes up to a factor of 2
}

}  // namespace
}  // namespace exitance
