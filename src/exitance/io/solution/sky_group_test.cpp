#include "exitance/io/solution/sky_group.hpp"

#include <gtest/gtest.h>

#include "exitance/scene/sky/directional_picture.hpp"
#include "exitance/scene/sky/sky_picture.hpp"
#include "exitance/scene/sky/sun_position.hpp"
#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

TEST(SkyGroup, PicturesAndFormulasAreReadBackAsWritten) {
    DirectionalPicture picture{64, 32, {}};
    for (std::size_t i = 0; i < 64 * 32 * bands; ++i) picture.radiance.push_back(static_cast<float>(i % 17));
    DistantLight light = light_of_picture(picture, 20);
    ASSERT_EQ(light.domes.size(), 2 * bands);
    light.domes.insert(light.domes.begin() + 1, {cie_sky(12, sky_direction(30, 100)), Spectrum(5.0)});
    light.discs.push_back({sky_direction(30, 100), sun_half_angle, Spectrum(7.0)});
    const TemporaryFolder folder;
    {
        Hdf5Writer file(folder / "sky.h5");
        file.make_group("scene");
        write_sky(file, "scene", light);
        ASSERT_TRUE(file.commit());
    }
    Result<Hdf5Reader> file = Hdf5Reader::open(folder / "sky.h5");
    ASSERT_TRUE(file);
    const DistantLight back = read_sky(*file, "scene");
    ASSERT_FALSE(file->failed());
    ASSERT_EQ(back.domes.size(), light.domes.size());
    EXPECT_FALSE(back.domes[1].model.picture);
    for (const Normal& w : {sky_direction(20, 30), sky_direction(80, 250), sky_direction(-40, 130)})
        EXPECT_EQ(back.radiosity(w, true), light.radiosity(w, true));
}

}  // namespace
}  // namespace exitance
