# Builds the working copy: nix-build packaging/nix. This derivation was not run.
{ pkgs ? import <nixpkgs> { } }:

let
  # nixpkgs has headers of tinygltf and cpp-httplib; the build needs a library of each.
  headerLibrary = name: package: source:
    pkgs.runCommandCC "lib${name}" { buildInputs = [ package pkgs.nlohmann_json pkgs.stb ]; } ''
      mkdir -p $out/lib
      cp ${pkgs.writeText "${name}.cpp" source} ${name}.cpp
      $CXX -std=c++20 -O2 -fPIC -c ${name}.cpp -o ${name}.o
      $AR rcs $out/lib/lib${name}.a ${name}.o
    '';
  tinygltf = headerLibrary "tinygltf" pkgs.tinygltf ''
    #define TINYGLTF_IMPLEMENTATION
    #define STB_IMAGE_IMPLEMENTATION
    #define STB_IMAGE_WRITE_IMPLEMENTATION
    #include <tiny_gltf.h>
  '';
  httplib = headerLibrary "cpp-httplib" pkgs.httplib "#include <httplib.h>";
in
pkgs.stdenv.mkDerivation {
  pname = "exitance";
  version = "0.3.0";
  src = pkgs.lib.cleanSource ../..;

  nativeBuildInputs = with pkgs; [ cmake ninja ];
  buildInputs = (with pkgs; [
    cgal cli11 embree fmt freetype gmp hdf5 libjpeg libpng mpfr nlohmann_json openexr tbb tomlplusplus zlib
  ]) ++ [ pkgs.tinygltf pkgs.httplib tinygltf httplib ];

  cmakeFlags = [
    "-DEXITANCE_TESTS=OFF"
    "-DEXITANCE_VIEWER=OFF"
    "-DEXITANCE_PYTHON=OFF"
    "-DEXITANCE_DISTRIBUTED=OFF"
    "-DEXITANCE_FONT=${pkgs.dejavu_fonts}/share/fonts/truetype/DejaVuSans.ttf"
  ];

  meta = {
    description = "Light in rooms of diffuse surfaces, with an estimate of its error";
    license = pkgs.lib.licenses.gpl3Plus;
    platforms = pkgs.lib.platforms.linux;
    mainProgram = "exitance";
  };
}
