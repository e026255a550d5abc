# Writes the shader files into one C++ source, so that the program needs no files at run time.
# Called as: cmake -DOUTPUT=… -DSOURCE_DIR=… -DSHADERS=a.glsl|b.frag|… -P embed_shaders.cmake
string(REPLACE "|" ";" names "${SHADERS}")
set(text "// Generated from render/shaders by embed_shaders.cmake.\n#include \"render/gl/shader_source.h\"\n\nnamespace slosh {\n\n")
string(APPEND text "std::span<const EmbeddedShader> embedded_shaders() {\n  static constexpr EmbeddedShader kShaders[] = {\n")
foreach(name IN LISTS names)
  file(READ "${SOURCE_DIR}/${name}" body)
  string(APPEND text "      {\"${name}\", R\"slosh_glsl(${body})slosh_glsl\"},\n")
endforeach()
string(APPEND text "  };\n  return kShaders;\n}\n\n}  // namespace slosh\n")
file(WRITE "${OUTPUT}" "${text}")
