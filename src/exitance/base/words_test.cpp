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
}

}  // namespace exitance
