# Copies the sources, adds a technique to the copy as CONTRIBUTING.md says, builds what it needs and runs it. Called with
# -D SOURCE=<top of the project> -D BUILD=<build tree> -D GENERATOR=<generator> -D COMPILER=<C++ compiler>.
cmake_policy(VERSION 3.25)
set(here ${SOURCE}/tests/toy_technique)
set(copy ${BUILD}/toy_technique/copy)
file(REMOVE_RECURSE ${BUILD}/toy_technique)
file(COPY ${SOURCE}/CMakeLists.txt ${SOURCE}/model ${SOURCE}/sim ${SOURCE}/validate DESTINATION ${copy})

# add(file before line): inserts lines before the text, which the file must contain once.
function(add file before lines)
  file(READ ${copy}/${file} text)
  string(FIND "${text}" "${before}" first)
  string(FIND "${text}" "${before}" last REVERSE)
  if(first EQUAL -1 OR NOT first EQUAL last)
    message(FATAL_ERROR "${file}: has not once: ${before}")
  endif()
  string(REPLACE "${before}" "${lines}${before}" text "${text}")
  file(WRITE ${copy}/${file} "${text}")
endfunction()

# 1. The parameters.
add(model/vocabulary/parameters.hpp "using Parameters = std::variant<"
    "struct EachPairParameters {\n  int step = 1;\n  bool operator==(const EachPairParameters&) const = default;\n};\n\n")
add(model/vocabulary/parameters.hpp ", PhotonMapParameters>" ", EachPairParameters")

# 2. The record.
add(model/vocabulary/technique.hpp "}  // namespace records"
    "inline constexpr std::array each_pair{number<&EachPairParameters::step>(\n    \"step\", \"step\", 1, 100, int64_t{2}, \"discs from one to the next\")};\n\n")
add(model/vocabulary/technique.hpp "\n};\n\nusing Parameter =" ",\n  each_pair")
add(model/vocabulary/technique.hpp "};\n\n[[nodiscard]] constexpr const TechniqueRecord& record_of("
    ",\n    TechniqueRecord{.technique = Technique::each_pair, .name = \"each-pair\", .parameters = records::each_pair,\n                    .defaults = EachPairParameters{}, .ray_by_ray = true,\n                    .division = {.plain = Division::rays, .simd = Division::rays}}")

# 3 and 4. The search, and its line.
configure_file(${here}/search.cpp ${copy}/sim/technique/each_pair.cpp COPYONLY)
add(sim/technique/registry.cpp ";\n\nnamespace {" ", prepare_each_pair")
add(sim/technique/registry.cpp "}};\n\n}  // namespace" "    {Technique::each_pair, prepare_each_pair},\n")

# 5 and 6. The closed form, if there is one, and its line.
configure_file(${here}/closed_form.cpp ${copy}/model/techniques/each_pair.cpp COPYONLY)
add(model/techniques/registry.cpp ";\n\nnamespace {" ", model_each_pair")
add(model/techniques/registry.cpp "};\n\n}  // namespace" "    {Technique::each_pair, model_each_pair},\n")

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(failed)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
endfunction()
# -O1 compiles the kernels in half the time; they need no instruction set but the compiler's own.
run(${CMAKE_COMMAND} -S ${here} -B ${BUILD}/toy_technique/tree -G ${GENERATOR} -D DETP_COPY=${copy}
    -D CMAKE_BUILD_TYPE=Release "-D CMAKE_CXX_FLAGS_RELEASE=-O1 -DHWY_COMPILE_ONLY_STATIC" -D CMAKE_UNITY_BUILD_BATCH_SIZE=20 -D CMAKE_UNITY_BUILD=ON -D CMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${BUILD}/toy_technique/tree --target toy)
run(${BUILD}/toy_technique/tree/toy)
