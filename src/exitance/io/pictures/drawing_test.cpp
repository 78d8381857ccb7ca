#include "exitance/io/pictures/drawing.hpp"

#include <gtest/gtest.h>

namespace exitance {
namespace {

Drawing sample() {
    Drawing d;
    d.size = {100, 50}, d.clip_hi = {100, 50};
    d.lines.push_back({{{1, 2}, {3, 4}, {5, 6}, {7, 8}}, {255, 0, 0}, 0.5, true, false, true});
    d.texts.push_back({{10, 10}, "E < 5 (m\xc2\xb2) \xe2\x82\xac", 3, {0, 0, 0}, true, true});
    return d;
}

TEST(Drawing, AsSvgHasItsSizeInMillimetresAndEscapedText) {
    const std::string svg = svg_of(sample());
    EXPECT_NE(svg.find("width=\"100.00mm\" height=\"50.00mm\""), std::string::npos);
    EXPECT_NE(svg.find("M1.00 2.00L3.00 4.00M5.00 6.00L7.00 8.00"), std::string::npos) << svg;
    EXPECT_NE(svg.find("E &lt; 5"), std::string::npos);
    EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
}

TEST(Drawing, AsPdfHasACorrectObjectTable) {
    const std::string pdf = pdf_of(sample());
    EXPECT_EQ(pdf.substr(0, 8), "%PDF-1.4");
    EXPECT_NE(pdf.find("MediaBox [0 0 283.465 141.732]"), std::string::npos);
    EXPECT_NE(pdf.find("(E < 5 \\(m\xb2\\) ?) Tj"), std::string::npos);
    const std::size_t table = static_cast<std::size_t>(std::stoul(pdf.substr(pdf.find("startxref") + 10)));
    ASSERT_EQ(pdf.substr(table, 4), "xref");
    for (std::size_t i = 1; i <= 5; ++i) {
        const std::size_t entry = pdf.find('\n', table + 5) + 1 + 20 * i;
        const std::size_t at = static_cast<std::size_t>(std::stoul(pdf.substr(entry, 10)));
        EXPECT_EQ(pdf.substr(at, 7), std::to_string(i) + " 0 obj");
    }
    const std::size_t stream = pdf.find("stream\n") + 7;
    const std::size_t length = static_cast<std::size_t>(std::stoul(pdf.substr(pdf.find("/Length ") + 8)));
    EXPECT_EQ(pdf.substr(stream + length, 9), "endstream");
}

}  // namespace
}  // namespace exitance
