# Formula for Homebrew on Linux. This formula was not run. It builds an archive of the working copy:
#
#   git archive --prefix exitance-0.3.0/ -o /tmp/exitance-0.3.0.tar.gz HEAD
#   HOMEBREW_EXITANCE_ARCHIVE=/tmp/exitance-0.3.0.tar.gz brew install --formula packaging/homebrew/exitance.rb
#
# For a tap, replace `url` by the address of the release's archive and add its `sha256`.
class Exitance < Formula
  desc "Light in rooms of diffuse surfaces, with an estimate of its error"
  url "file://#{ENV.fetch("HOMEBREW_EXITANCE_ARCHIVE", "/tmp/exitance-0.3.0.tar.gz")}"
  version "0.3.0"
  license "GPL-3.0-or-later"

  depends_on "cgal" => :build
  depends_on "cli11" => :build
  depends_on "cmake" => :build
  depends_on "ninja" => :build
  depends_on "nlohmann-json" => :build
  depends_on "tomlplusplus" => :build
  depends_on "cpp-httplib"
  depends_on "embree"
  depends_on "fmt"
  depends_on "freetype"
  depends_on "gmp"
  depends_on "hdf5"
  depends_on "jpeg-turbo"
  depends_on "libpng"
  depends_on :linux
  depends_on "mpfr"
  depends_on "openexr"
  depends_on "tbb"
  depends_on "tinygltf"
  depends_on "zlib"

  def install
    font = Dir["/usr/share/fonts/**/DejaVuSans.ttf"].first
    odie "DejaVuSans.ttf is required: install the font package dejavu of your distribution" if font.nil?
    system "cmake", "-S", ".", "-B", "build", "-G", "Ninja", "-DEXITANCE_TESTS=OFF", "-DEXITANCE_VIEWER=OFF",
           "-DEXITANCE_PYTHON=OFF", "-DEXITANCE_DISTRIBUTED=OFF", "-DEXITANCE_FONT=#{font}",
           *std_cmake_args
    system "cmake", "--build", "build"
    system "cmake", "--install", "build"
  end

  test do
    system bin/"exitance", "generate", "office", "nx=1", "ny=1", "-o", "room.obj"
    system bin/"exitance", "solve", "room.obj", "-o", "room.h5", "--error", "0.1"
  end
end
