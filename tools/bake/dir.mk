# The baker. Only gltf_load.cpp sees tinygltf, a shared library of the distribution.
BAKE_OBJS := $(patsubst %.cpp,$(B)/%.o,$(wildcard tools/bake/*.cpp))
$(B)/tools/bake/gltf_load.o: HOST_INC = $$($(PKG_CONFIG) --cflags tinygltf)

PROGRAMS += $(BIN)/ew-bake
$(BIN)/ew-bake: $(BAKE_OBJS) $(B)/tools/common/options.o
	@mkdir -p $(@D)
	$(CXX) $(HOST_CXXFLAGS) $(LDFLAGS) -o $@ $^ $$($(PKG_CONFIG) --libs tinygltf)
