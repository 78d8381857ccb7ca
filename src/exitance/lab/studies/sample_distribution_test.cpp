#include "exitance/lab/studies/sample_distribution.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <sstream>

#include "support/built_scene.hpp"

namespace exitance {

TEST(SampleDistribution, FollowsTheResourceFromTheEmitterToOtherFaces) {
    const Scene scene = box_scene(1, 2, 1.5, 0.5, 10);  // the ceiling emits
    CsvText text;
    text.print("%s\n", sample_distribution_header);
    write_sample_distribution("box", scene, {8, 32}, 200, 1, text, StopRequest());
    std::size_t rows[2] = {}, resampled = 0;
    std::string line;
    std::istringstream lines(text.text());
    std::getline(lines, line);
    while (std::getline(lines, line)) {
        char name[8];
        std::size_t units;
        int near, visible;
        double x[3], y[3];
        ASSERT_EQ(std::sscanf(line.c_str(), "%3[^,],%zu,%d,%d,%lf,%lf,%lf,%lf,%lf,%lf", name, &units, &near, &visible,
                              &x[0], &x[1], &x[2], &y[0], &y[1], &y[2]),
                  10)
            << line;
        ++rows[units == 32];
        resampled += static_cast<std::size_t>(near);
        EXPECT_EQ(visible, 1);  // there are no blockers
        EXPECT_DOUBLE_EQ(y[2], 1.5);
        EXPECT_LT(x[2], 1.5);
    }
    EXPECT_EQ(rows[0], 200u);
    EXPECT_EQ(rows[1], 200u);
    EXPECT_GT(resampled, 100u);  // half of them, minus pairs that do not face each other
}

}  // namespace exitance
