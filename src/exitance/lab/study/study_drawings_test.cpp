#include "exitance/lab/study/study_drawings.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace exitance {
namespace {

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

TEST(StudyDrawings, EveryShapeIsDrawnInItsPicture) {
    Table table;
    add_shape(table, "a", "dot", {0, 0}, "#112233");
    add_shape(table, "a", "box", {0, 0, 10, 5}, "#445566");
    add_shape(table, "a", "triangle", {0, 0, 10, 0, 5, 5}, "#778899");
    add_shape(table, "a", "line", {0, 0, 10, 5}, "#aabbcc");
    add_shape(table, "b", "circle", {2, 2, 3, 2}, "#ddeeff");
    StudyDrawing drawing;
    drawing.x_label = "seconds";
    const std::string a = svg_of_shapes(drawing, table, "a"), b = svg_of_shapes(drawing, table, "b");
    for (const char* colour : {"#112233", "#445566", "#778899", "#aabbcc"}) {
        EXPECT_EQ(count_of(a, colour), 1u);
        EXPECT_EQ(count_of(b, colour), 0u);
    }
    EXPECT_EQ(count_of(b, "#ddeeff"), 1u);
    EXPECT_NE(a.find(">seconds<"), std::string::npos);
    EXPECT_NE(a.find(">10<"), std::string::npos);
    // The box fills the frame: 640 x 440 pixels with a margin of 48.
    EXPECT_NE(a.find("x=\"48.00\" y=\"48.00\" width=\"544.00\" height=\"344.00\""), std::string::npos);
    // The circle is in the frame, although its own columns are only its centre and one point.
    EXPECT_NE(b.find("cx=\"320.0\" cy=\"220.0\" r=\"272.0\""), std::string::npos) << b;
}

TEST(StudyDrawings, EqualAxesKeepShapesUndistorted) {
    Table table;
    add_shape(table, "a", "box", {0, 0, 1, 1}, "#445566");
    StudyDrawing drawing;
    drawing.equal_axes = true;
    EXPECT_NE(svg_of_shapes(drawing, table, "a").find("width=\"344.00\" height=\"344.00\""), std::string::npos);
}

TEST(StudyDrawings, OnePictureIsWrittenPerName) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "exitance_drawings";
    Table table;
    for (const char* name : {"16 units", "64 units", "16 units"}) add_shape(table, name, "dot", {0, 0}, "#112233");
    Study study;
    StudyDrawing& drawing = study.drawings.emplace_back();
    drawing.name = drawing.table = "growth";
    const auto drawn = draw_shapes(study, {{"growth", table}}, folder.string());
    ASSERT_TRUE(drawn);
    ASSERT_EQ(drawn->size(), 2u);
    EXPECT_TRUE(std::filesystem::exists((*drawn)[1].svg));
    std::filesystem::remove_all(folder);
}

TEST(StudyDrawings, ColoursOfSharesRunFromDarkToLight) {
    EXPECT_EQ(share_colour(-1), "#440154");
    EXPECT_EQ(share_colour(0.5), "#21918c");
    EXPECT_EQ(share_colour(2), "#fde725");
}

}  // namespace
}  // namespace exitance
