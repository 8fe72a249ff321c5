from .content import Content as Content, one_line as one_line
from .gmsh_files import read_msh as read_msh
from .legacy_vtk import read_legacy as read_legacy
from .off import read_off as read_off
from .ply import read_ply as read_ply
from .shapes import VtpFile as VtpFile, read_vtp as read_vtp
from .stl import read_stl as read_stl
from .wavefront import read_obj as read_obj
from .xml_vtk import XmlFile as XmlFile, read_xml as read_xml
