# Tests of the mesh readers, which are internal to the loader.
ajar_test(mesh unit FILES mesh_obj_test.cpp mesh_ply_test.cpp mesh_serialized_test.cpp mesh_side_test.cpp
          mesh_damage_test.cpp USES ajar_scene)
target_include_directories(test_mesh PRIVATE ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(test_mesh PRIVATE ZLIB::ZLIB)

ajar_fuzz(mesh fuzz_mesh.cpp ${CMAKE_CURRENT_SOURCE_DIR}/corpus/mesh 200 USES ajar_scene)
target_include_directories(fuzz_mesh PRIVATE ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(fuzz_mesh PRIVATE ZLIB::ZLIB)
