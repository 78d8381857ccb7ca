#pragma once

#include <string>

namespace exitance::test {

/// A photometric file (IES LM-63-2002): a lamp of 4000 lm whose opening, 0.6 x 1.2 m, is as bright from all sides.
inline constexpr const char* downlight =
    "IESNA:LM-63-2002\n[TEST] own\n[MANUFAC] nobody\nTILT=NONE\n1 4000 1 7 1 1 2 0.6 1.2 0\n1 1 20\n"
    "0 15 30 45 60 75 90\n0\n1000 965.9 866 707.1 500 258.8 0\n";

/// A weather file (.epw) with the hours of 21 June: sun and sky of constant irradiance from 6 to 18 o'clock.
inline std::string weather_of_a_day() {
    std::string text = "LOCATION,Town,-,CHE,test,0,47.4,8.5,1.0,400\n";
    for (int i = 0; i < 7; ++i) text += "HEADER\n";
    for (int hour = 1; hour <= 24; ++hour) {
        const bool day = hour > 6 && hour < 19;
        text += "2021,6,21," + std::to_string(hour) + ",0,f,10,5,70,95000,0,1300,300,500," + (day ? "600,120" : "0,0") +
                ",0,0,0\n";
    }
    return text;
}

}  // namespace exitance::test
