# Appended to tests/CMakeLists.txt of the work copy: what its test programs run their tests with.
target_sources(astrosplat_test_main PRIVATE ${CMAKE_CURRENT_LIST_DIR}/run_tests.cpp)
