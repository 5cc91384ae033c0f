# Writes a source with a digest of libraries: cmake -D LIBRARIES=A,B -D TARGET=code_digest.cpp -P code_digest.cmake
string(REPLACE "," ";" LIBRARIES "${LIBRARIES}")
set(all "")
foreach(library ${LIBRARIES})
  file(SHA256 "${library}" digest)
  string(APPEND all "${digest}")
endforeach()
string(SHA256 digest "${all}")
file(WRITE "${TARGET}" "namespace corridor {
const char* codeDigest();
const char* codeDigest() {
  return \"${digest}\";
}
}  // namespace corridor
")
