<?xml version="1.0" encoding="UTF-8"?>
<CityModel xmlns="http://www.opengis.net/citygml/3.0" xmlns:bldg="http://www.opengis.net/citygml/building/3.0" xmlns:con="http://www.opengis.net/citygml/construction/3.0" xmlns:gen="http://www.opengis.net/citygml/generics/3.0" xmlns:gml="http://www.opengis.net/gml/3.2" xmlns:xAL="urn:oasis:names:tc:ciq:xal:3" xmlns:xlink="http://www.w3.org/1999/xlink" gml:id="cm.model">
<gml:description>citymesh VERSION export-for-simulation; crs EPSG:25833; unit metre; axes x east, y north, z up, right-handed; origin 391000 5820000 0</gml:description>
<gml:boundedBy>
<gml:Envelope srsName="urn:ogc:def:crs:EPSG::25833" srsDimension="3">
<gml:lowerCorner>390980.0000 5820000.0000 -0.0001                            </gml:lowerCorner>
<gml:upperCorner>391001.0000 5820011.2501 9.1249                             </gml:upperCorner>
</gml:Envelope>
</gml:boundedBy>
<cityObjectMember>
<bldg:Building gml:id="cube">
<gml:metaDataProperty><gml:GenericMetaData>citymesh rung as_is</gml:GenericMetaData></gml:metaDataProperty>
<boundary>
<con:GroundSurface gml:id="ground">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m0">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p0">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820001.0000 0.0000 391001.0000 5820001.0000 0.0000 391001.0000 5820000.0000 0.0000 391000.0000 5820000.0000 0.0000 391000.0000 5820001.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:GroundSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_0">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m1">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p1">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820000.0000 0.0000 391001.0000 5820000.0000 0.0000 391001.0000 5820000.0000 1.0000 391000.0000 5820000.0000 1.0000 391000.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_1">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m2">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p2">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391001.0000 5820000.0000 0.0000 391001.0000 5820001.0000 0.0000 391001.0000 5820001.0000 1.0000 391001.0000 5820000.0000 1.0000 391001.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_2">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m3">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p3">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391001.0000 5820001.0000 0.0000 391000.0000 5820001.0000 0.0000 391000.0000 5820001.0000 1.0000 391001.0000 5820001.0000 1.0000 391001.0000 5820001.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_3">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m4">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p4">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820001.0000 0.0000 391000.0000 5820000.0000 0.0000 391000.0000 5820000.0000 1.0000 391000.0000 5820001.0000 1.0000 391000.0000 5820001.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:RoofSurface gml:id="roof">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m5">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p5">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820000.0000 1.0000 391001.0000 5820000.0000 1.0000 391001.0000 5820001.0000 1.0000 391000.0000 5820001.0000 1.0000 391000.0000 5820000.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:RoofSurface>
</boundary>
<lod2Solid>
<gml:Solid gml:id="cm.cube.s0">
<gml:exterior>
<gml:Shell gml:id="cm.cube.k0">
<gml:surfaceMember xlink:href="#cm.cube.p0"/>
<gml:surfaceMember xlink:href="#cm.cube.p1"/>
<gml:surfaceMember xlink:href="#cm.cube.p2"/>
<gml:surfaceMember xlink:href="#cm.cube.p3"/>
<gml:surfaceMember xlink:href="#cm.cube.p4"/>
<gml:surfaceMember xlink:href="#cm.cube.p5"/>
</gml:Shell>
</gml:exterior>
</gml:Solid>
</lod2Solid>
<con:height>
<con:Height>
<con:highReference>highestRoofEdge</con:highReference>
<con:lowReference>lowestGroundPoint</con:lowReference>
<con:status>measured</con:status>
<con:value uom="m">1</con:value>
</con:Height>
</con:height>
<bldg:function>31001_1000</bldg:function>
</bldg:Building>
</cityObjectMember>
<cityObjectMember>
<bldg:Building gml:id="house">
<gml:metaDataProperty><gml:GenericMetaData>citymesh rung as_is</gml:GenericMetaData></gml:metaDataProperty>
<boundary>
<con:GroundSurface gml:id="ground_3">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.house.m0">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.house.p0">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390980.0000 5820003.0001 -0.0001 390980.0000 5820011.2501 -0.0001 390990.5000 5820011.2501 -0.0001 390990.5000 5820003.0001 -0.0001 390980.0000 5820003.0001 -0.0001</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:GroundSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="south">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.house.m1">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.house.p1">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390980.0000 5820003.0001 -0.0001 390990.5000 5820003.0001 -0.0001 390990.5000 5820003.0001 5.0624 390980.0000 5820003.0001 5.0624 390980.0000 5820003.0001 -0.0001</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="east">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.house.m2">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.house.p2">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390990.5000 5820003.0001 -0.0001 390990.5000 5820011.2501 -0.0001 390990.5000 5820011.2501 5.0624 390990.5000 5820007.1251 9.1249 390990.5000 5820003.0001 5.0624 390990.5000 5820003.0001 -0.0001</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="north">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.house.m3">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.house.p3">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390990.5000 5820011.2501 -0.0001 390980.0000 5820011.2501 -0.0001 390980.0000 5820011.2501 5.0624 390990.5000 5820011.2501 5.0624 390990.5000 5820011.2501 -0.0001</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="west">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.house.m4">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.house.p4">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390980.0000 5820011.2501 -0.0001 390980.0000 5820003.0001 -0.0001 390980.0000 5820003.0001 5.0624 390980.0000 5820007.1251 9.1249 390980.0000 5820011.2501 5.0624 390980.0000 5820011.2501 -0.0001</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:RoofSurface gml:id="roof_south">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.house.m5">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.house.p5">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390980.0000 5820003.0001 5.0624 390990.5000 5820003.0001 5.0624 390990.5000 5820007.1251 9.1249 390980.0000 5820007.1251 9.1249 390980.0000 5820003.0001 5.0624</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:RoofSurface>
</boundary>
<boundary>
<con:RoofSurface gml:id="roof_north">
<lod2MultiSurface>
<gml:MultiSurface gml:id="cm.house.m6">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.house.p6">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390990.5000 5820011.2501 5.0624 390980.0000 5820011.2501 5.0624 390980.0000 5820007.1251 9.1249 390990.5000 5820007.1251 9.1249 390990.5000 5820011.2501 5.0624</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod2MultiSurface>
</con:RoofSurface>
</boundary>
<lod2Solid>
<gml:Solid gml:id="cm.house.s0">
<gml:exterior>
<gml:Shell gml:id="cm.house.k0">
<gml:surfaceMember xlink:href="#cm.house.p0"/>
<gml:surfaceMember xlink:href="#cm.house.p1"/>
<gml:surfaceMember xlink:href="#cm.house.p2"/>
<gml:surfaceMember xlink:href="#cm.house.p3"/>
<gml:surfaceMember xlink:href="#cm.house.p4"/>
<gml:surfaceMember xlink:href="#cm.house.p5"/>
<gml:surfaceMember xlink:href="#cm.house.p6"/>
</gml:Shell>
</gml:exterior>
</gml:Solid>
</lod2Solid>
<bldg:buildingPart>
<bldg:BuildingPart gml:id="annex">
<boundary>
<con:GroundSurface gml:id="ground_2">
<lod1MultiSurface>
<gml:MultiSurface gml:id="cm.annex.m0">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.annex.p0">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390995.0000 5820006.0000 0.0000 390998.0000 5820006.0000 0.0000 390998.0000 5820003.0000 0.0000 390995.0000 5820003.0000 0.0000 390995.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod1MultiSurface>
</con:GroundSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_0_2">
<lod1MultiSurface>
<gml:MultiSurface gml:id="cm.annex.m1">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.annex.p1">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390995.0000 5820003.0000 0.0000 390998.0000 5820003.0000 0.0000 390998.0000 5820003.0000 2.5000 390995.0000 5820003.0000 2.5000 390995.0000 5820003.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod1MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_1_2">
<lod1MultiSurface>
<gml:MultiSurface gml:id="cm.annex.m2">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.annex.p2">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390998.0000 5820003.0000 0.0000 390998.0000 5820006.0000 0.0000 390998.0000 5820006.0000 2.5000 390998.0000 5820003.0000 2.5000 390998.0000 5820003.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod1MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_2_2">
<lod1MultiSurface>
<gml:MultiSurface gml:id="cm.annex.m3">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.annex.p3">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390998.0000 5820006.0000 0.0000 390995.0000 5820006.0000 0.0000 390995.0000 5820006.0000 2.5000 390998.0000 5820006.0000 2.5000 390998.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod1MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:WallSurface gml:id="wall_3_2">
<lod1MultiSurface>
<gml:MultiSurface gml:id="cm.annex.m4">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.annex.p4">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390995.0000 5820006.0000 0.0000 390995.0000 5820003.0000 0.0000 390995.0000 5820003.0000 2.5000 390995.0000 5820006.0000 2.5000 390995.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod1MultiSurface>
</con:WallSurface>
</boundary>
<boundary>
<con:RoofSurface gml:id="roof_2">
<lod1MultiSurface>
<gml:MultiSurface gml:id="cm.annex.m5">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.annex.p5">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390995.0000 5820003.0000 2.5000 390998.0000 5820003.0000 2.5000 390998.0000 5820006.0000 2.5000 390995.0000 5820006.0000 2.5000 390995.0000 5820003.0000 2.5000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</lod1MultiSurface>
</con:RoofSurface>
</boundary>
<lod1Solid>
<gml:Solid gml:id="cm.annex.s0">
<gml:exterior>
<gml:Shell gml:id="cm.annex.k0">
<gml:surfaceMember xlink:href="#cm.annex.p0"/>
<gml:surfaceMember xlink:href="#cm.annex.p1"/>
<gml:surfaceMember xlink:href="#cm.annex.p2"/>
<gml:surfaceMember xlink:href="#cm.annex.p3"/>
<gml:surfaceMember xlink:href="#cm.annex.p4"/>
<gml:surfaceMember xlink:href="#cm.annex.p5"/>
</gml:Shell>
</gml:exterior>
</gml:Solid>
</lod1Solid>
</bldg:BuildingPart>
</bldg:buildingPart>
</bldg:Building>
</cityObjectMember>
</CityModel>
