#include "exitance/io/files/base64.hpp"

#include <gtest/gtest.h>

namespace exitance {

TEST(Base64, AgreesWithTheExamplesOfItsStandard) {
    const auto of = [](const std::string& text) { return base64(std::as_bytes(std::span(text))); };
    EXPECT_EQ(of(""), "");
    EXPECT_EQ(of("f"), "Zg==");
    EXPECT_EQ(of("fo"), "Zm8=");
    EXPECT_EQ(of("foo"), "Zm9v");
    EXPECT_EQ(of("foobar"), "Zm9vYmFy");
    EXPECT_EQ(of("\xff\xfe\xfd"), "//79");
}

}  // namespace exitance
