#include "exitance/base/words.hpp"

#include <gtest/gtest.h>

namespace exitance {

TEST(Words, QuotesKeepBlanksAndTheOpenQuoteIsFound) {
    EXPECT_EQ(split_words(" a  --camera \"1,2 3\" 'b c' x'y z'\"\""),
              (std::vector<std::string>{"a", "--camera", "1,2 3", "b c", "xy z"}));
    EXPECT_EQ(open_quote("a 'b \"c' d"), 0);
    EXPECT_EQ(open_quote("a 'b \"c"), '\'');
    EXPECT_EQ(open_quote("a \"b 'c"), '"');
}

TEST(Words, ShellTextIsReadBackAsTheSameWords) {
    const std::vector<std::string> words{"solve", "my room.obj", "-o", "/a/r.h5", "", "\"q\"", "{x};"};
    EXPECT_EQ(split_words(shell_text(words)), words);
    EXPECT_EQ(shell_text({"a=1,2", "it's"}), "a=1,2 'it'\\''s'");
}

TEST(Words, JsonTextHasNoControlCharactersAndReadsOtherBytesAsLatin1) {
    EXPECT_EQ(json_text("caf\xe9 \"1\"\n"), "\"caf\\u00e9 \\\"1\\\"\\u000a\"");
    EXPECT_EQ(json_text("caf\xc3\xa9"), "\"caf\xc3\xa9\"");
    // A surrogate, a longer form of a short code, and a code above the last one are not UTF-8.
    EXPECT_EQ(json_text("\xed\xa0\x80"), "\"\\u00ed\\u00a0\\u0080\"");
    EXPECT_EQ(json_text("\xe0\x80\x80"), "\"\\u00e0\\u0080\\u0080\"");
    EXPECT_EQ(json_text("\xf4\x90\x80\x80"), "\"\\u00f4\\u0090\\u0080\\u0080\"");
    EXPECT_EQ(json_text("\xf0\x9f\x92\xa1"), "\"\xf0\x9f\x92\xa1\"");
}

}  // namespace exitance
