# Blender's Cycles as a second renderer for pictures of phr. Called by tests/cycles.sh:
#
#   blender -b --factory-startup -P tests/cycles.py -- \
#       SCENE.obj A.view SIZE SAMPLES SEED OUT.pfm
#   python3 tests/cycles.py PHR.pfm A.pfm B.pfm AVERAGE.pfm LAMP
#
# The first renders SIZE x SIZE pixels: the path tracer alone, diffuse bounces up to 64,
# nothing clamped, filtered or denoised. It reads OBJ, MTL and view by itself; a polygon
# is cut into a fan, as phr cuts convex ones, and vn is passed over. A surface reflects
# Kd, and emits the radiance Ke / pi, in front; its back is black. The numbers stay
# linear, and so are those of the picture, radiances, times pi: radiosities as phr's.
#
# Lengths are scaled so that the scene is $LENGTH (1) long. Cycles 3.4 compares the edge
# of a lamp's triangle with its distance over twice its area (triangle_light_sample() has
# a normal not of length 1), so that in small units it always samples the solid angle,
# which it makes of fast_acosf(), and loses light where it is small.
#
# The second writes the average of A and B, two pictures by Cycles of different seeds, and
# prints by how many percent phr's picture is brighter, in each band and in all, and the
# noise of the average: the RMS over blocks of 8 x 8 pixels of half the difference of A
# and B, in percent of that of phr's. Blocks where phr shows more than LAMP are left out.

import array
import math
import os
import sys

BOUNCES = 64
LENGTH = float(os.environ.get('LENGTH', 1))  # of the scene, for Cycles
BLOCK = 8  # pixels along a side


def read_pfm(path):
    """Width, height and samples, the bottom row first."""
    kind, size, scale, data = open(path, 'rb').read().split(b'\n', 3)
    samples = array.array('f', data)
    assert kind == b'PF' and float(scale) < 0 and sys.byteorder == 'little'
    return tuple(map(int, size.split())) + (samples,)


def write_pfm(path, width, height, samples):
    with open(path, 'wb') as out:
        out.write(b'PF\n%d %d\n-1.0\n' % (width, height))
        array.array('f', samples).tofile(out)


# --- phr's files ---

def lines_of(path):
    """The words of each line that has any."""
    for line in open(path):
        words = line.split('#')[0].split()
        if words:
            yield words


def read_materials(path):
    """Kd and Ke of each material."""
    materials = {}
    for keyword, *rest in lines_of(path):
        if keyword == 'newmtl':
            material = materials[rest[0]] = {'Kd': (0, 0, 0), 'Ke': (0, 0, 0)}
        elif keyword in ('Kd', 'Ke'):
            material[keyword] = tuple(map(float, rest))
    return materials


def read_scene(path):
    """Points, materials, and triangles: three numbers of points, a material's name."""
    points, materials, triangles, name = [], {}, [], None
    for keyword, *rest in lines_of(path):
        if keyword == 'mtllib':
            materials.update(read_materials(os.path.join(os.path.dirname(path), rest[0])))
        elif keyword == 'v':
            points.append(tuple(map(float, rest[:3])))
        elif keyword == 'usemtl':
            name = rest[0]
        elif keyword == 'f':
            numbers = [int(word.split('/')[0]) for word in rest]
            corner = [n - 1 if n > 0 else len(points) + n for n in numbers]
            triangles += [(corner[0], corner[k], corner[k + 1], name)
                          for k in range(1, len(corner) - 1)]
    return points, materials, triangles


def read_view(path):
    view = {'up': [0, 1, 0], 'fov': [45]}
    for keyword, *rest in lines_of(path):
        view[keyword] = list(map(float, rest))
    return view


# --- Cycles ---

def make_material(bpy, name, kd, ke):
    """Kd and Ke in front, black behind: both are mixed with black by Backfacing."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    back = nodes.new('ShaderNodeNewGeometry').outputs['Backfacing']

    def in_front(colour):
        mix = nodes.new('ShaderNodeMixRGB')
        mix.inputs['Color1'].default_value = colour + (1,)
        mix.inputs['Color2'].default_value = (0, 0, 0, 1)
        links.new(back, mix.inputs['Fac'])
        return mix.outputs['Color']

    diffuse = nodes.new('ShaderNodeBsdfDiffuse')
    diffuse.inputs['Roughness'].default_value = 0
    links.new(in_front(kd), diffuse.inputs['Color'])
    shader = diffuse.outputs['BSDF']
    if max(ke) > 0:
        emission, both = nodes.new('ShaderNodeEmission'), nodes.new('ShaderNodeAddShader')
        emission.inputs['Strength'].default_value = max(ke) / math.pi
        links.new(in_front(tuple(x / max(ke) for x in ke)), emission.inputs['Color'])
        links.new(shader, both.inputs[0])
        links.new(emission.outputs['Emission'], both.inputs[1])
        shader = both.outputs['Shader']
    links.new(shader, nodes.new('ShaderNodeOutputMaterial').inputs['Surface'])
    return material


def make_scene(bpy, path):
    """Returns the factor on lengths."""
    points, materials, triangles = read_scene(path)
    scale = LENGTH / max(max(axis) - min(axis) for axis in zip(*points))
    points = [[scale * x for x in point] for point in points]
    names = sorted({name for *corners, name in triangles})
    mesh = bpy.data.meshes.new('scene')
    mesh.from_pydata(points, [], [corners for *corners, name in triangles])
    for name in names:
        mesh.materials.append(make_material(bpy, name, **{
            key.lower(): value for key, value in materials[name].items()}))
    for polygon, (*corners, name) in zip(mesh.polygons, triangles):
        assert list(polygon.vertices) == corners
        polygon.material_index = names.index(name)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new('scene', mesh))
    return scale


def make_camera(bpy, path, scale):
    from mathutils import Matrix, Vector

    view = read_view(path)
    eye, at, up = (scale * Vector(view[key]) for key in ('eye', 'at', 'up'))
    back = (eye - at).normalized()
    right = up.cross(back).normalized()
    axes = right, back.cross(right), back
    data = bpy.data.cameras.new('camera')
    data.sensor_fit = 'VERTICAL'
    data.lens = data.sensor_height / 2 / math.tan(math.radians(view['fov'][0]) / 2)
    data.clip_start, data.clip_end = 1e-4 * LENGTH, 100 * LENGTH
    camera = bpy.data.objects.new('camera', data)
    camera.matrix_world = Matrix([[*(axis[k] for axis in axes), eye[k]]
                                  for k in range(3)] + [[0, 0, 0, 1]])
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def set_options(scene, size, samples, seed):
    scene.render.engine = 'CYCLES'
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.render.use_compositing = scene.render.use_sequencer = False
    scene.render.image_settings.file_format = 'OPEN_EXR'
    scene.render.image_settings.color_depth = '32'
    scene.render.image_settings.color_mode = 'RGB'
    cycles = scene.cycles
    cycles.samples, cycles.seed = samples, seed
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.max_bounces = cycles.diffuse_bounces = BOUNCES
    cycles.caustics_reflective = cycles.caustics_refractive = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0
    cycles.use_fast_gi = False
    cycles.film_exposure = 1
    cycles.pixel_filter_type = 'BOX'


def render(bpy, scene_path, view_path, size, samples, seed, output):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new('dark')
    scene.world.color = 0, 0, 0
    make_camera(bpy, view_path, make_scene(bpy, scene_path))
    set_options(scene, int(size), int(samples), int(seed))
    scene.render.filepath = output + '.exr'
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(os.path.abspath(output + '.exr'))
    image.colorspace_settings.name = 'Non-Color'
    pixels = list(image.pixels)
    width, height = image.size
    os.remove(output + '.exr')
    write_pfm(output, width, height,
              [math.pi * x for i, x in enumerate(pixels) if i % 4 < 3])


# --- comparison ---

def block_means(samples, width, height):
    """The mean of each band in each block of pixels."""
    for y in range(0, height, BLOCK):
        for x in range(0, width, BLOCK):
            at = [3 * (j * width + i) for j in range(y, min(y + BLOCK, height))
                  for i in range(x, min(x + BLOCK, width))]
            yield [sum(samples[i + band] for i in at) / len(at) for band in range(3)]


def compare(phr, first, second, average, lamp):
    width, height, shown = read_pfm(phr)
    a, b = (read_pfm(path) for path in (first, second))
    assert (width, height) == a[:2] == b[:2]
    samples = [(x + y) / 2 for x, y in zip(a[2], b[2])]
    write_pfm(average, width, height, samples)
    masked = [x > float(lamp) for x in shown]
    blocks = [ours + theirs + apart for ours, theirs, apart, lamps in zip(*(
        block_means(x, width, height)
        for x in (shown, samples, [(x - y) / 2 for x, y in zip(a[2], b[2])], masked)))
        if max(lamps) == 0]
    sums = [sum(column) for column in zip(*blocks)]
    for band, name in enumerate(('red', 'green', 'blue')):
        print('%s %+.2f' % (name, 100 * (sums[band] / sums[3 + band] - 1)))
    print('all %+.2f' % (100 * (sum(sums[:3]) / sum(sums[3:6]) - 1)))
    squares = [sum(x * x for x in column) for column in zip(*blocks)]
    print('noise %.2f' % (100 * math.sqrt(sum(squares[6:]) / sum(squares[:3]))))


if '--' in sys.argv:
    import bpy
    render(bpy, *sys.argv[sys.argv.index('--') + 1:])
else:
    compare(*sys.argv[1:])
