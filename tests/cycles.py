# Blender's Cycles as a second renderer: a picture of NAME.blend, made by
# tools/to_blender.py, in W/m^2:
#
#   blender -b NAME.blend -P tests/cycles.py -- SAMPLES SEED OUT.pfm
#
# The path tracer alone, diffuse bounces up to 64, nothing clamped, filtered or denoised.
import array, math, os, sys
import bpy

samples, seed, output = sys.argv[sys.argv.index('--') + 1:]
scene = bpy.context.scene
render, cycles, settings = scene.render, scene.cycles, scene.render.image_settings
render.use_compositing = render.use_sequencer = False
settings.file_format, settings.color_depth, settings.color_mode = 'OPEN_EXR', '32', 'RGB'
cycles.samples, cycles.seed = int(samples), int(seed)
cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_fast_gi = False
cycles.max_bounces = cycles.diffuse_bounces = 64
cycles.caustics_reflective = cycles.caustics_refractive = False
cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
cycles.light_sampling_threshold = 0
cycles.film_exposure, cycles.pixel_filter_type = 1, 'BOX'
render.filepath = os.path.abspath(output) + '.exr'
bpy.ops.render.render(write_still=True)
image = bpy.data.images.load(render.filepath)
image.colorspace_settings.name = 'Non-Color'
light = array.array('f', (math.pi * x for i, x in enumerate(image.pixels[:])
                          if i % 4 < 3))
os.remove(render.filepath)
with open(output, 'wb') as out:
    out.write(b'PF\n%d %d\n-1.0\n' % tuple(image.size))
    light.tofile(out)
