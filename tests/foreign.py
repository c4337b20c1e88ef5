# Opens phr's outputs FOLDER/a.* in VTK, meshio or Blender, and compares every number with
# those of the .pfm, the .ppm and the .ply, read here byte by byte. Prints "ok NAME" or
# "not ok NAME" lines. Called by tests/88-foreign.sh:
#
#   python3 tests/foreign.py vtk|meshio|gltf FOLDER
#   blender -b --factory-startup -P tests/foreign.py -- blender FOLDER

import struct
import sys

SIZES = {'uchar': 'B', 'int': 'i', 'uint': 'I', 'float': 'f', 'double': 'd'}


def check(name, good):
    print('ok' if good else 'not ok', name, flush=True)


def nearest(a, b, share):
    """Whether numbers differ by at most a share of the largest of each pixel of b."""
    largest = [max(b[i - i % 3:i - i % 3 + 3]) for i in range(len(b))]
    return len(a) == len(b) > 0 and all(
        abs(a[i] - b[i]) <= share * largest[i] for i in range(len(b)))


def read_picture(path):
    """Width, height and samples of a PFM or PPM, the bottom row first."""
    kind, size, scale, data = open(path, 'rb').read().split(b'\n', 3)
    width, height = map(int, size.split())
    if kind == b'PF':
        return width, height, struct.unpack('<%df' % (3 * width * height), data)
    rows = [data[3 * width * y:3 * width * (y + 1)] for y in range(height)]
    return width, height, tuple(b''.join(reversed(rows)))


def read_ply(path):
    """Vertices and faces, each a list of dictionaries."""
    header, data = open(path, 'rb').read().split(b'end_header\n', 1)
    elements, at = {}, 0
    for words in map(str.split, header.decode().splitlines()):
        if words[0] == 'element':
            properties = []
            elements[words[1]] = int(words[2]), properties
        elif words[0] == 'property':
            properties.append((words[-1], words[1:-1]))
    found = {}
    for name in 'vertex', 'face':
        count, properties = elements[name]
        layout = '<' + ''.join('B3i' if kind[0] == 'list' else SIZES[kind[0]]
                               for _, kind in properties)
        names = [n for p, kind in properties
                 for n in (['count', 0, 1, 2] if kind[0] == 'list' else [p])]
        step = struct.calcsize(layout)
        found[name] = [dict(zip(names, struct.unpack_from(layout, data, at + step * i)))
                       for i in range(count)]
        at += step * count
    return found['vertex'], found['face']


def columns(records, *names):
    return [record[name] for record in records for name in names]


RADIOSITY = 'radiosity_r', 'radiosity_g', 'radiosity_b'


def look_with_vtk(folder):
    from vtkmodules.vtkIOImage import vtkHDRReader, vtkPNGReader
    from vtkmodules.vtkIOLegacy import vtkUnstructuredGridReader
    from vtkmodules.vtkIOPLY import vtkPLYReader

    def read(reader, suffix):
        reader.SetFileName(folder + '/a.' + suffix)
        reader.Update()
        return reader.GetOutput()

    def numbers(array):
        width = array.GetNumberOfComponents() if array else 0
        return [array.GetComponent(i, k) for i in range(array.GetNumberOfTuples())
                for k in range(width)] if array else []

    vertices, faces = read_ply(folder + '/a.ply')
    mesh = read(vtkUnstructuredGridReader(), 'vtk')
    ids = mesh.GetCells().GetConnectivityArray()
    cells, points = mesh.GetCellData(), mesh.GetPointData()
    check('VTK: points of .vtk', numbers(mesh.GetPoints().GetData()) ==
          columns(vertices, 'x', 'y', 'z'))
    check('VTK: triangles', numbers(ids) == columns(faces, 0, 1, 2))
    check('VTK: radiosity of cells', numbers(cells.GetArray('radiosity')) ==
          columns(faces, *RADIOSITY))
    for name in 'root', 'hierarchy', 'error':
        check('VTK: ' + name, numbers(cells.GetArray(name)) == columns(faces, name))
    check('VTK: level', numbers(cells.GetArray('level')) ==
          [(n.bit_length() - 1) // 2 for n in columns(faces, 'hierarchy')])
    check('VTK: radiosity of points', numbers(points.GetArray('radiosity')) ==
          columns(vertices, *RADIOSITY))
    mesh = read(vtkPLYReader(), 'ply')
    check('VTK: points of .ply', numbers(mesh.GetPoints().GetData()) ==
          columns(vertices, 'x', 'y', 'z'))
    check('VTK: their colours', numbers(mesh.GetPointData().GetArray('RGB')) ==
          columns(vertices, 'red', 'green', 'blue'))
    codes, light = (read_picture(folder + '/a.' + s)[2] for s in ('ppm', 'pfm'))
    picture = read(vtkPNGReader(), 'png').GetPointData().GetScalars()
    check('VTK: .png has the codes of .ppm', numbers(picture) == list(codes))
    picture = read(vtkHDRReader(), 'hdr').GetPointData().GetScalars()
    check('VTK: .hdr has the light of .pfm', nearest(numbers(picture), light, 1 / 256))


def look_with_blender(folder):
    import bpy

    vertices, faces = read_ply(folder + '/a.ply')
    bpy.ops.import_mesh.ply(filepath=folder + '/a.ply')
    mesh = bpy.context.object.data
    check('Blender: points of .ply', [x for v in mesh.vertices for x in v.co] ==
          columns(vertices, 'x', 'y', 'z'))
    triangles = [i for p in mesh.polygons for i in p.vertices]
    check('Blender: triangles', triangles == columns(faces, 0, 1, 2))
    corners = [vertices[loop.vertex_index] for loop in mesh.loops]
    colours = [round(255 * x) for colour in mesh.vertex_colors[0].data
               for x in colour.color[:3]]
    check('Blender: colours', colours == columns(corners, 'red', 'green', 'blue'))
    import numpy
    numpy.bool = bool  # which Debian's add-on still asks for
    bpy.ops.import_scene.gltf(filepath=folder + '/a.glb', merge_vertices=False)
    mesh = bpy.context.object.data
    check('Blender: triangles of .glb', len(mesh.polygons) == len(faces) and
          [i for p in mesh.polygons for i in p.vertices] == columns(faces, 0, 1, 2))
    check('Blender: its colours', len(mesh.color_attributes) == 1)
    width, height, codes = read_picture(folder + '/a.ppm')
    light = read_picture(folder + '/a.pfm')[2]

    def pixels(suffix):
        image = bpy.data.images.load(folder + '/a.' + suffix)
        values = list(image.pixels)
        return [x for i, x in enumerate(values) if i % 4 < 3] if \
            tuple(image.size) == (width, height) else []

    check('Blender: .png has the codes of .ppm',
          [round(255 * x) for x in pixels('png')] == list(codes))
    check('Blender: .hdr has the light of .pfm', nearest(pixels('hdr'), light, 1 / 128))


def look_with_meshio(folder):
    import meshio

    vertices, faces = read_ply(folder + '/a.ply')
    mesh = meshio.read(folder + '/a.vtk')
    check('meshio: points', mesh.points.ravel().tolist() ==
          columns(vertices, 'x', 'y', 'z'))
    check('meshio: triangles', mesh.cells_dict['triangle'].ravel().tolist() ==
          columns(faces, 0, 1, 2))
    for name, keys in ('radiosity', RADIOSITY), ('root', ['root']), ('error', ['error']):
        check('meshio: ' + name, mesh.cell_data[name][0].ravel().tolist() ==
              columns(faces, *keys))
    check('meshio: radiosity of points', mesh.point_data['radiosity'].ravel().tolist() ==
          columns(vertices, *RADIOSITY))


def look_at_gltf(folder):
    """What Khronos' validator asks of such a file, and the numbers."""
    import json

    vertices, faces = read_ply(folder + '/a.ply')
    data = open(folder + '/a.glb', 'rb').read()
    magic, version, length, json_length, json_type = struct.unpack_from('<4sIII4s', data)
    text = data[20:20 + json_length]
    bin_length, bin_type = struct.unpack_from('<I4s', data, 20 + json_length)
    rest = data[28 + json_length:]
    check('glTF: head and chunks', (magic, version, length, json_type, bin_type) ==
          (b'glTF', 2, len(data), b'JSON', b'BIN\0') and len(rest) == bin_length and
          json_length % 4 == bin_length % 4 == 0)
    gltf = json.loads(text)
    sizes = {5123: 2, 5125: 4, 5126: 4}
    widths = {'SCALAR': 1, 'VEC3': 3, 'VEC4': 4}
    arrays, fits = [], gltf['buffers'][0]['byteLength'] == bin_length
    for accessor in gltf['accessors']:
        view = gltf['bufferViews'][accessor['bufferView']]
        width = widths[accessor['type']] * sizes[accessor['componentType']]
        fits = fits and view['byteLength'] == accessor['count'] * width and \
            view['byteOffset'] % 4 == width % 4 == 0 and \
            view['byteOffset'] + view['byteLength'] <= bin_length
        kind = {5123: 'H', 5125: 'I', 5126: 'f'}[accessor['componentType']]
        count = accessor['count'] * widths[accessor['type']]
        arrays.append(struct.unpack_from('<%d%s' % (count, kind), rest,
                                         view['byteOffset']))
    check('glTF: accessors fit into views, views into the buffer', fits)
    at, colours, corners = arrays
    box = gltf['accessors'][0]
    single = struct.Struct('<3f')
    check('glTF: the box is that of the positions', [
        single.pack(*box['min']), single.pack(*box['max'])] == [
        single.pack(*[limit(at[k::3]) for k in range(3)]) for limit in (min, max)])
    check('glTF: triangles', list(corners) == columns(faces, 0, 1, 2))
    m = gltf['nodes'][0]['matrix']
    placed = [sum(m[4 * k + row] * at[i + k] for k in range(3)) + m[12 + row]
              for i in range(0, len(at), 3) for row in range(3)]
    size = max(box['max'])
    check('glTF: positions', all(abs(a - b) < 1e-6 * size for a, b in zip(
        placed, columns(vertices, 'x', 'y', 'z'))))
    exposure = gltf['asset']['extras']['exposure']
    light = [min(1, exposure * x) * 65535 for x in columns(vertices, *RADIOSITY)]
    check('glTF: colours are linear, times the exposure', all(
        abs(light[3 * i + k] - colours[4 * i + k]) < 1 and colours[4 * i + 3] == 65535
        for i in range(len(vertices)) for k in range(3)))
    check('glTF: nothing lights it', gltf['extensionsUsed'] == ['KHR_materials_unlit'] and
          gltf['materials'][0]['extensions'] == {'KHR_materials_unlit': {}})


program, folder = sys.argv[-2:]
{'vtk': look_with_vtk, 'meshio': look_with_meshio, 'gltf': look_at_gltf,
 'blender': look_with_blender}[program](folder)
check(program + ' has opened all', True)
