"""STEP from Open CASCADE; importing this takes seconds, and fails where that is not installed."""

from io import BytesIO

from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.Interface import Interface_Static
from OCP.Message import Message, Message_PrinterOStream
from OCP.StepBasic import StepBasic_Product
from OCP.STEPControl import STEPControl_Controller, STEPControl_StepModelType, STEPControl_Writer
from OCP.StepData import StepData_StepModel
from OCP.TCollection import TCollection_HAsciiString

from ocs_design.parts.brep import part_brep
from ocs_design.parts.part import Part

_SETTINGS = {"write.step.schema": "AP214IS", "write.step.unit": "MM"}

_CURVES_ON_SURFACES = "write.surfacecurve.mode"
"""Off: readers make them from the curves in space, and the file is half as large."""

_TIMESTAMP = "2000-01-01T00:00:00"
"""In every file, so that the same part has the same bytes."""


def write_step(part: Part) -> bytes:
    """The part as one solid that bears its name."""
    # Open CASCADE reports to standard output, where a command's JSON goes.
    Message.DefaultMessenger_s().RemovePrinters(Message_PrinterOStream.get_type_descriptor_s())
    # Before that there are no settings.
    STEPControl_Controller.Init_s()
    for setting, value in _SETTINGS.items():
        Interface_Static.SetCVal_s(setting, value)
    Interface_Static.SetIVal_s(_CURVES_ON_SURFACES, 0)
    writer = STEPControl_Writer()
    writer.Transfer(part_brep(part), STEPControl_StepModelType.STEPControl_AsIs)
    _identify(writer.Model(), part.name)
    buffer = BytesIO()
    writer.WriteStream(buffer)
    return buffer.getvalue()


def _identify(model: StepData_StepModel, name: str) -> None:
    """Name and time in place of counters and clocks."""
    title = TCollection_HAsciiString(name)
    header = APIHeaderSection_MakeHeader(model)
    header.SetName(title)
    header.SetDescriptionValue(1, title)
    header.SetTimeStamp(TCollection_HAsciiString(_TIMESTAMP))
    header.SetOriginatingSystem(TCollection_HAsciiString("ocs-design"))
    for number in range(1, model.NbEntities() + 1):
        entity = model.Value(number)
        if isinstance(entity, StepBasic_Product):
            entity.SetName(title)
            entity.SetId(title)
