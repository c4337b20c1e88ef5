# phr: parallel hierarchical radiosity.
#
#   make                 phr with mpicc
#   make SERIAL=1        the same without MPI, with cc
#   make demo            the Cornell box, 2 ranks    make check      all tests
#   make room            build/room, a scene generator
#   make pathtracer      build/pathtracer, which phr's pictures and meshes are compared
#                        with
#   make bench           $(BUILD)/hits, a bench of rays and of segments, beside Embree
#                        where it is installed
#   make errors          $(BUILD)/reference and $(BUILD)/measure: phr against a path
#                        tracer
#   make chart           docs/chart.csv, docs/accuracy.md and, with gnuplot,
#                        docs/chart-*.svg: speed against error
#   make front           docs/front.csv, a table in docs/accuracy.md and, with gnuplot,
#                        docs/front.svg: seconds against the error of pictures, by
#                        settings: the defaults are to be on the front
#   make growth          docs/growth.csv, docs/growth.svg, a table in docs/scaling.md:
#                        rooms of 6,348 to a million triangles
#   make scaling         docs/ranks.md: seconds on 1, 32 and 1,024 ranks, line by line;
#                        in docs/scaling.md what ranks repeat, by instructions, and
#                        their memory
#   make tables          docs/tables.md, docs/fig3.svg: Tables 1 and 2 and Fig. 3 of the
#                        paper, by counts and processor seconds
#   make pages           docs/ablation.md, docs/stability.md: each idea off and on; what
#                        breaks radiosity programs (make ablation, make stability)
#   make numbers         docs/numbers.md: half and twice of each tuned number
#   make docs            all of these pages and the course's
#   make course          the programs, outputs and figures of docs/course/
#   make exercise N=1    tests answers to the exercises of a chapter
#   make film            build/film/, a solution growing, frame by frame; with
#                        ImageMagick docs/film.gif
#   make answers         scenes/answers.csv: the light of the scenes for lectures, by
#                        paths
#   make oracle          docs/oracle.md: who gets how many digits of what is right
#   make panel           every kind of scene in small, against its truth, a line each;
#                        with BEFORE=commit beside what that made; SCENES='cornell door'
#   make prove           long tests: `make check` on more ranks and by more compilers;
#                        errors over six fourfold steps of epsilon; 500 random sets of
#                        options; kills at forty moments
#   make corpus          build/corpus: scenes for other renderers, with right pictures
#                        and the standard errors of their pixels
#   make cycles          these beside those of Blender's Cycles, where it is installed
#   make golden          renews the golden pictures in tests/golden (on purpose only), or
#                        that of CASE=NAME
#   make pace            renews the instructions of runs in tests/pace (on purpose only)
#   make portability     golden pictures on other compilers, MPIs, processors
#   make fuzz            build/fuzz/fuzz-FORMAT with clang: libFuzzer and sanitizers
#   make install         to $(DESTDIR)$(prefix), phr as it was built last, with SERIAL=1
#                        or without                  make uninstall  make clean
#   make install-lib     libphr.a and phr.h, for other programs: docs/library.md
#
# Knobs: MPICC, CC, MPIEXEC, CFLAGS, CPPFLAGS, LDFLAGS, prefix, DESTDIR.
# Other builds side by side: BUILD is where objects go, PHR and IMGDIFF the programs made
# of them.

SHELL = /bin/sh
.SUFFIXES:
.SECONDARY:

MPICC ?= mpicc
CFLAGS ?= -O3 -g
INSTALL ?= install
OBJCOPY ?= objcopy
prefix ?= /usr/local
bindir = $(prefix)/bin
libdir = $(prefix)/lib
includedir = $(prefix)/include
mandir = $(prefix)/share/man
docdir = $(prefix)/share/doc/phr
PHR ?= phr
IMGDIFF ?= build/imgdiff

# The results depend on these: C99 without extensions, no fused multiply-add. (Without
# errno no result changes, and sqrt and llrint become instructions.)
STRICT = -std=c99 -ffp-contract=off -fno-math-errno
WARN = -pedantic -Wall -Wextra -Wshadow -Wconversion

# How PHR was built last.
ifneq ($(filter install install-lib,$(MAKECMDGOALS)),)
-include build/$(notdir $(PHR)).kind
endif

ifdef SERIAL
BUILD ?= build/serial
COMPILE = $(CC)
MPI_INCLUDE = -Impi/serial
MPIEXEC = sh tests/alone.sh
else
BUILD ?= build/mpi
COMPILE = $(or $(if $(shell command -v $(firstword $(MPICC)) 2>/dev/null),$(MPICC)), \
    $(error no $(MPICC): install an MPI, or build without: make SERIAL=1))
MPI_INCLUDE =
MPIEXEC ?= mpiexec
endif

# All sources of these folders but the programs.
OCTREE = $(wildcard octree/*.c)
PROGRAMS = tools/imgdiff tools/pathtracer tools/id tools/score tools/viewfactors/main
FOLDERS = geom rad rad/beyond rad/beyond/gather mpi mpi/beyond io/scene io/run \
          io/picture tools tools/viewfactors lib
SOURCES = $(wildcard $(FOLDERS:%=%/*.c)) $(OCTREE)
# OCTREE= BRUTE=brute builds with tests/brute.c in place of octree/.
BRUTE =
MODULES = $(filter-out $(PROGRAMS),$(sort $(SOURCES:%.c=%))) $(BRUTE:%=tests/%)
OBJECTS = $(MODULES:%=$(BUILD)/%.o)

# Unit tests, bottom up; the last four are run with several ranks. Their sources lie in
# folders, the programs do not: tests/geom/alloc.c becomes $(BUILD)/tests/alloc.
TESTS = alloc elementary triangle lambert hull doubles scene polygon side wall \
        contour octree bundles bicgstab sequence id flux patch compact formfactor \
        patch_exchange factors link patch_link method cluster node oracle error_oracle \
        pushpull equation \
        final_gather lamps checksum paths meter plan balance assign gather_mesh \
        spotcheck \
        text obj ply output files machine store tone image png texture hdr camera \
        viewpoint shading mesh render options progress screened stop norms \
        stability converge linking exchange conjugate exact
vpath %.c tests/geom tests/octree tests/rad tests/rad/beyond tests/mpi tests/io
vpath %.c tests/tools tests/whole

# Programs that compare phr with what is true.
BENCHES = reference measure direct replay prices
# Judges of the panel: leaves and pictures.
JUDGES = judge shown
# Formats with a fuzz harness in tests/fuzz/ and a corpus, which is replayed as a test.
FUZZERS = obj mtl ply stl image view points sky cases links checkpoint clusters
REPLAYS = $(FUZZERS:%=$(BUILD)/tests/fuzz/%)
TEST_PROGRAMS = $(TESTS:%=$(BUILD)/tests/%) $(REPLAYS)

all: $(PHR) $(IMGDIFF) build/viewfactors build/id build/score

# Linked beside the objects and copied, so that `make` after `make SERIAL=1` changes phr
# again.
$(PHR): $(BUILD)/phr FORCE
	@cmp -s $(BUILD)/phr $@ || cp $(BUILD)/phr $@
	@mkdir -p build
	@printf '%s\n' "$(if $(SERIAL),SERIAL = 1)" "BUILD ?= $(BUILD)" >build/$(@F).kind

$(IMGDIFF): $(BUILD)/imgdiff FORCE
	@mkdir -p $(@D)
	@cmp -s $(BUILD)/imgdiff $@ || cp $(BUILD)/imgdiff $@

build/id build/score build/viewfactors build/pathtracer: build/%: $(BUILD)/% FORCE
	@mkdir -p build
	@cmp -s $< $@ || cp $< $@

$(BUILD)/phr: $(BUILD)/phr.o $(BUILD)/libphr.a
	$(COMPILE) $(CFLAGS) $(LDFLAGS) -o $@ $(BUILD)/phr.o $(BUILD)/libphr.a -lm

$(BUILD)/imgdiff $(BUILD)/id $(BUILD)/score $(BUILD)/pathtracer: $(BUILD)/%: \
    $(BUILD)/tools/%.o $(BUILD)/libphr.a
	$(COMPILE) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$(BUILD)/viewfactors: $(BUILD)/tools/viewfactors/main.o $(BUILD)/libphr.a
	$(COMPILE) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$(BUILD)/tests/%: $(BUILD)/tests/%.o $(BUILD)/libphr.a
	$(COMPILE) $(CFLAGS) $(LDFLAGS) -o $@ $< $(BUILD)/libphr.a -lm

# The truth, for the tests and benches that compare phr with it.
TRUTH = $(BUILD)/tests/truth.o $(BUILD)/tests/deviation.o

$(BUILD)/tests/norms $(BUILD)/tests/converge: $(BUILD)/tests/%: \
    $(BUILD)/tests/%.o $(TRUTH) $(BUILD)/libphr.a
	$(COMPILE) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

pathtracer: build/pathtracer

$(REPLAYS): $(BUILD)/tests/fuzz/%: $(BUILD)/tests/fuzz/%.o $(BUILD)/tests/corpus.o \
    $(BUILD)/libphr.a
	$(COMPILE) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$(BUILD)/libphr.a: $(OBJECTS) $(BUILD)/tests/phr.o
	rm -f $@ && ar rcs $@ $^

COMPILED = $(COMPILE) $(STRICT) $(WARN) -I. $(MPI_INCLUDE) $(CFLAGS) $(CPPFLAGS) \
           -MMD -MP -c -o $@ $<

$(BUILD)/%.o: %.c Makefile
	@mkdir -p $(@D)
	$(COMPILED)

$(TESTS:%=$(BUILD)/tests/%.o): $(BUILD)/tests/%.o: %.c Makefile
	@mkdir -p $(@D)
	$(COMPILED)

# compute_light(), for tests and benches, without a main() in the way of theirs.
$(BUILD)/tests/phr.o: phr.c Makefile
	@mkdir -p $(@D)
	$(COMPILED) -Dmain=program_main

-include $(OBJECTS:.o=.d) $(BUILD)/phr.d $(BUILD)/tests/phr.d \
    $(PROGRAMS:%=$(BUILD)/%.d) $(TESTS:%=$(BUILD)/tests/%.d) \
    $(REPLAYS:=.d) $(BUILD)/tests/corpus.d $(TRUTH:.o=.d) \
    $(BENCHES:%=$(BUILD)/tests/bench/%.d) $(JUDGES:%=$(BUILD)/tests/panel/%.d)

demo: $(PHR)
	$(MPIEXEC) -n 2 ./$(PHR) scenes/cornell.obj --view scenes/cornell.view \
	    -o cornell.png -o cornell.pfm -o cornell.ply

tests: $(TEST_PROGRAMS)

room: build/room

build/room: scenes/room.c Makefile
	@mkdir -p build
	$(CC) $(STRICT) $(WARN) $(CFLAGS) -o $@ scenes/room.c -lm

# Set EMBREE= to leave Embree out where its header is found.
EMBREE ?= $(wildcard /usr/include/embree3/rtcore.h /usr/local/include/embree3/rtcore.h)

bench: $(BUILD)/hits build/room

$(BUILD)/hits: tests/bench/hits.c tests/bench/bench.h rad/beyond/paths.c \
    $(BUILD)/libphr.a Makefile
	$(COMPILE) $(STRICT) $(WARN) $(if $(EMBREE),-DWITH_EMBREE) -I. $(MPI_INCLUDE) \
	    $(CFLAGS) -o $@ \
	    $< $(BUILD)/libphr.a $(if $(EMBREE),-lembree3) -lm

errors: $(BUILD)/reference $(BUILD)/measure

$(JUDGES:%=$(BUILD)/%): $(BUILD)/%: $(BUILD)/tests/panel/%.o $(TRUTH) $(BUILD)/libphr.a
	$(COMPILE) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

$(BENCHES:%=$(BUILD)/%): $(BUILD)/%: $(BUILD)/tests/bench/%.o $(TRUTH) $(BUILD)/libphr.a
	$(COMPILE) $(CFLAGS) $(LDFLAGS) -o $@ $^ -lm

# About an hour and a half on two cores, half an hour of it for references that are kept
# in $(BUILD)/chart.
chart: $(BENCHES:%=$(BUILD)/%) $(BUILD)/hits build/room
	BUILD="$(BUILD)" MPIEXEC="$(MPIEXEC)" sh tests/bench/chart.sh

# About half an hour on two cores, most of it for traced pictures, which are kept in
# $(BUILD)/front; PATHS=256, for blocks alone, takes five minutes.
front: $(PHR) $(IMGDIFF) pathtracer build/room
	BUILD="$(BUILD)" MPIEXEC="$(MPIEXEC)" sh tests/bench/front.sh

# About five minutes on two cores.
growth: $(PHR) build/room
	BUILD="$(BUILD)" MPIEXEC="$(MPIEXEC)" sh tests/bench/growth.sh

# About five minutes on two cores.
scaling: $(PHR) $(BUILD)/replay build/room
	BUILD="$(BUILD)" MPIEXEC="$(MPIEXEC)" sh tests/bench/scaling.sh
	BUILD="$(BUILD)" MPIEXEC="$(MPIEXEC)" sh tests/bench/repeated.sh

# About twelve minutes on two cores, three of them for linking all pairs.
tables: $(PHR) build/room
	BUILD="$(BUILD)" MPIEXEC="$(MPIEXEC)" sh tests/bench/tables.sh

pages: ablation stability

# About three minutes on two cores.
ablation: $(PHR) $(BENCHES:%=$(BUILD)/%) build/room
	BUILD="$(BUILD)" MPIEXEC="$(MPIEXEC)" sh tests/bench/ablation.sh

# Some minutes on two cores, once `make panel` has made its truths.
numbers: errors $(JUDGES:%=$(BUILD)/%) $(PHR) pathtracer build/viewfactors build/room
	BUILD="$(BUILD)" MAKE="$(MAKE)" sh tests/bench/numbers.sh

# About two minutes on two cores.
stability: $(PHR) $(JUDGES:%=$(BUILD)/%)
	BUILD="$(BUILD)" MPIEXEC="$(MPIEXEC)" sh tests/bench/stability.sh

docs:
	@echo "All pages take three hours and a half on two cores."
	@for page in chart front growth scaling tables pages numbers oracle course; do \
	    echo "$$(date +%H:%M) make $$page"; $(MAKE) $$page || exit 1; done

# The programs of docs/course/.
COURSE = build/id $(patsubst docs/course/%.c,build/course/%,$(wildcard docs/course/*.c))

build/course/%: docs/course/%.c $(BUILD)/libphr.a
	@mkdir -p $(@D)
	$(COMPILE) $(STRICT) $(WARN) -I. $(MPI_INCLUDE) $(CFLAGS) -o $@ $< $(BUILD)/libphr.a -lm

# Half a minute on two cores, from nothing.
course: $(PHR) $(IMGDIFF) build/viewfactors $(COURSE) build/room
	MPIEXEC="$(MPIEXEC)" CC="$(COMPILE)" BUILD="$(BUILD)" sh docs/course/run.sh
	MPIEXEC="$(MPIEXEC)" sh docs/course/figures.sh

build/oracle/%: docs/oracle/%.c $(BUILD)/libphr.a
	@mkdir -p $(@D)
	$(COMPILE) $(STRICT) $(WARN) -I. $(MPI_INCLUDE) $(CFLAGS) -o $@ $< $(BUILD)/libphr.a -lm

exercise: $(BUILD)/libphr.a
	CC="$(COMPILE)" BUILD="$(BUILD)" sh docs/course/exercise.sh $(N)

# Half a minute on two cores.
film: $(PHR)
	MPIEXEC="$(MPIEXEC)" FILM=build/film sh tools/film.sh
	[ ! -e build/film/film.gif ] || cp build/film/film.gif docs/film.gif

# Two minutes on two cores.
oracle: $(PHR) build/viewfactors build/score build/oracle/hemicube
	sh docs/oracle/oracle.sh

# About five minutes on two cores.
answers: $(PHR) pathtracer build/room build/course/leaves
	MPIEXEC="$(MPIEXEC)" sh scenes/answers.sh >build/answers.csv
	mv build/answers.csv scenes/answers.csv

check: $(PHR) $(IMGDIFF) build/viewfactors build/score build/oracle/hemicube pathtracer \
    tests build/room bench \
    $(BENCHES:%=$(BUILD)/%) $(JUDGES:%=$(BUILD)/%) $(COURSE)
	cp scenes/room.mtl $(BUILD)/tests
	build/room 1000 1 >$(BUILD)/tests/room.obj
	$(BUILD)/direct scenes/shadow.obj $(BUILD)/tests/shadow.ref 10000
	MPIEXEC="$(MPIEXEC)" MPICC="$(MPICC)" CC="$(CC)" MAKE="$(MAKE)" BUILD="$(BUILD)" \
	    sh tests/run.sh $(TESTS)

# Only on purpose: what the pictures are now becomes what is expected.
golden: $(PHR)
	CASE="$(CASE)" sh tests/golden.sh tests/golden ./$(PHR)

# Only on purpose, too: what runs take now becomes what they may take.
pace: $(PHR) build/room
	BUILD="$(BUILD)" PHR="$(PHR)" RENEW=yes sh tests/56-pace.sh

portability:
	MAKE="$(MAKE)" sh tests/portability.sh

# About three minutes.
check-long: $(PHR)
	MPIEXEC="$(MPIEXEC)" BUILD="$(BUILD)" sh tests/kill.sh

# About an hour, most of it for references that are kept in $(BUILD)/prove.
prove: errors $(PHR) $(IMGDIFF) pathtracer build/room check-long
	$(MAKE) check PROVE=yes
	BUILD="$(BUILD)" sh tests/prove.sh
	MPIEXEC="$(MPIEXEC)" BUILD="$(BUILD)" RUNS=500 SEED=2 sh tests/68-sweep.sh

# About five minutes on two cores, and ten more for truths, which are kept in
# $(BUILD)/panel/truth. All runs are on one rank.
panel: errors $(JUDGES:%=$(BUILD)/%) $(PHR) pathtracer build/viewfactors build/room
	@BEFORE="$(BEFORE)" SCENES="$(SCENES)" MPIEXEC="$(MPIEXEC)" MAKE="$(MAKE)" \
	    BUILD="$(BUILD)" PHR="./$(PHR)" sh tests/panel/panel.sh

# With SIZE=64 178 s of a core; seconds grow with the pixels.
corpus: $(PHR)
	@MPIEXEC="$(MPIEXEC)" PHR="./$(PHR)" sh tests/corpus.sh

# Some minutes more, for Blender's pictures.
cycles: corpus $(IMGDIFF)
	MPIEXEC="$(MPIEXEC)" BUILD="$(BUILD)" sh tests/cycles.sh

# To be run as build/fuzz/fuzz-obj NEW tests/fuzz/corpus/obj, say: finds go to the folder
# NEW.
fuzz:
	$(MAKE) SERIAL=1 CC=clang BUILD=build/fuzz $(FUZZERS:%=build/fuzz/fuzz-%) \
	    CFLAGS="-g -O1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all"

$(BUILD)/fuzz-%: $(BUILD)/tests/fuzz/%.o $(BUILD)/libphr.a
	$(COMPILE) $(CFLAGS) -fsanitize=fuzzer -o $@ $^ -lm

INSTALLED = phr imgdiff viewfactors

install: $(PHR) $(BUILD)/imgdiff $(BUILD)/viewfactors
	mkdir -p $(DESTDIR)$(bindir) $(DESTDIR)$(mandir)/man1 $(DESTDIR)$(docdir)
	$(INSTALL) -m 755 $(PHR) $(DESTDIR)$(bindir)/phr
	$(INSTALL) -m 755 $(BUILD)/imgdiff $(BUILD)/viewfactors $(DESTDIR)$(bindir)
	$(INSTALL) -m 644 phr.1 tools/imgdiff.1 tools/viewfactors/viewfactors.1 \
	    $(DESTDIR)$(mandir)/man1
	$(INSTALL) -m 644 LICENSE $(DESTDIR)$(docdir)

# One object, of whose names only those of lib/phr.h stay global.
$(BUILD)/lib/libphr.a: $(BUILD)/lib/phr.o $(BUILD)/libphr.a
	rm -f $@
	$(LD) -r -o $(@D)/one.o $^
	$(OBJCOPY) --wildcard --keep-global-symbol='phr_*' $(@D)/one.o
	ar rcs $@ $(@D)/one.o

install-lib: $(BUILD)/lib/libphr.a
	mkdir -p $(DESTDIR)$(libdir) $(DESTDIR)$(includedir)
	$(INSTALL) -m 644 $(BUILD)/lib/libphr.a $(DESTDIR)$(libdir)
	$(INSTALL) -m 644 lib/phr.h $(DESTDIR)$(includedir)

uninstall:
	rm -f $(INSTALLED:%=$(DESTDIR)$(bindir)/%)
	rm -f $(INSTALLED:%=$(DESTDIR)$(mandir)/man1/%.1)
	rm -f $(DESTDIR)$(docdir)/LICENSE
	rm -f $(DESTDIR)$(libdir)/libphr.a $(DESTDIR)$(includedir)/phr.h

clean:
	rm -rf build phr cornell.png cornell.pfm cornell.ply

FORCE:

.PHONY: all demo tests room pathtracer bench errors chart front growth scaling tables \
    check pages ablation numbers stability docs course exercise film answers oracle \
    panel check-long prove corpus cycles golden pace portability fuzz install \
        install-lib uninstall clean FORCE
