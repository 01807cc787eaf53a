<?xml version="1.0" encoding="UTF-8"?>
<CityModel xmlns="http://www.opengis.net/citygml/2.0" xmlns:bldg="http://www.opengis.net/citygml/building/2.0" xmlns:gen="http://www.opengis.net/citygml/generics/2.0" xmlns:gml="http://www.opengis.net/gml" xmlns:xAL="urn:oasis:names:tc:ciq:xsdschema:xAL:2.0" xmlns:xlink="http://www.w3.org/1999/xlink" gml:id="cm.model">
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
<bldg:function>31001_1000</bldg:function>
<bldg:measuredHeight uom="m">1</bldg:measuredHeight>
<bldg:lod2Solid>
<gml:Solid gml:id="cm.cube.s0">
<gml:exterior>
<gml:CompositeSurface gml:id="cm.cube.k0">
<gml:surfaceMember xlink:href="#cm.cube.p0"/>
<gml:surfaceMember xlink:href="#cm.cube.p1"/>
<gml:surfaceMember xlink:href="#cm.cube.p2"/>
<gml:surfaceMember xlink:href="#cm.cube.p3"/>
<gml:surfaceMember xlink:href="#cm.cube.p4"/>
<gml:surfaceMember xlink:href="#cm.cube.p5"/>
</gml:CompositeSurface>
</gml:exterior>
</gml:Solid>
</bldg:lod2Solid>
<bldg:boundedBy>
<bldg:GroundSurface gml:id="ground">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m0">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p0">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820001.0000 0.0000 391001.0000 5820001.0000 0.0000 391001.0000 5820000.0000 0.0000 391000.0000 5820000.0000 0.0000 391000.0000 5820001.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:GroundSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_0">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m1">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p1">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820000.0000 0.0000 391001.0000 5820000.0000 0.0000 391001.0000 5820000.0000 1.0000 391000.0000 5820000.0000 1.0000 391000.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_1">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m2">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p2">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391001.0000 5820000.0000 0.0000 391001.0000 5820001.0000 0.0000 391001.0000 5820001.0000 1.0000 391001.0000 5820000.0000 1.0000 391001.0000 5820000.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_2">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m3">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p3">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391001.0000 5820001.0000 0.0000 391000.0000 5820001.0000 0.0000 391000.0000 5820001.0000 1.0000 391001.0000 5820001.0000 1.0000 391001.0000 5820001.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="wall_3">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m4">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p4">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820001.0000 0.0000 391000.0000 5820000.0000 0.0000 391000.0000 5820000.0000 1.0000 391000.0000 5820001.0000 1.0000 391000.0000 5820001.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:RoofSurface gml:id="roof">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.cube.m5">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.cube.p5">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">391000.0000 5820000.0000 1.0000 391001.0000 5820000.0000 1.0000 391001.0000 5820001.0000 1.0000 391000.0000 5820001.0000 1.0000 391000.0000 5820000.0000 1.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:RoofSurface>
</bldg:boundedBy>
</bldg:Building>
</cityObjectMember>
<cityObjectMember>
<bldg:Building gml:id="house">
<gml:metaDataProperty><gml:GenericMetaData>citymesh rung as_is</gml:GenericMetaData></gml:metaDataProperty>
<bldg:lod2Solid>
<gml:Solid gml:id="cm.house.s0">
<gml:exterior>
<gml:CompositeSurface gml:id="cm.house.k0">
<gml:surfaceMember xlink:href="#cm.house.p0"/>
<gml:surfaceMember xlink:href="#cm.house.p1"/>
<gml:surfaceMember xlink:href="#cm.house.p2"/>
<gml:surfaceMember xlink:href="#cm.house.p3"/>
<gml:surfaceMember xlink:href="#cm.house.p4"/>
<gml:surfaceMember xlink:href="#cm.house.p5"/>
<gml:surfaceMember xlink:href="#cm.house.p6"/>
</gml:CompositeSurface>
</gml:exterior>
</gml:Solid>
</bldg:lod2Solid>
<bldg:boundedBy>
<bldg:GroundSurface gml:id="ground_3">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.house.m0">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.house.p0">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390980.0000 5820003.0001 -0.0001 390980.0000 5820011.2501 -0.0001 390990.5000 5820011.2501 -0.0001 390990.5000 5820003.0001 -0.0001 390980.0000 5820003.0001 -0.0001</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:GroundSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="south">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.house.m1">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.house.p1">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390980.0000 5820003.0001 -0.0001 390990.5000 5820003.0001 -0.0001 390990.5000 5820003.0001 5.0624 390980.0000 5820003.0001 5.0624 390980.0000 5820003.0001 -0.0001</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="east">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.house.m2">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.house.p2">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390990.5000 5820003.0001 -0.0001 390990.5000 5820011.2501 -0.0001 390990.5000 5820011.2501 5.0624 390990.5000 5820007.1251 9.1249 390990.5000 5820003.0001 5.0624 390990.5000 5820003.0001 -0.0001</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="north">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.house.m3">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.house.p3">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390990.5000 5820011.2501 -0.0001 390980.0000 5820011.2501 -0.0001 390980.0000 5820011.2501 5.0624 390990.5000 5820011.2501 5.0624 390990.5000 5820011.2501 -0.0001</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:WallSurface gml:id="west">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.house.m4">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.house.p4">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390980.0000 5820011.2501 -0.0001 390980.0000 5820003.0001 -0.0001 390980.0000 5820003.0001 5.0624 390980.0000 5820007.1251 9.1249 390980.0000 5820011.2501 5.0624 390980.0000 5820011.2501 -0.0001</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:WallSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:RoofSurface gml:id="roof_south">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.house.m5">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.house.p5">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390980.0000 5820003.0001 5.0624 390990.5000 5820003.0001 5.0624 390990.5000 5820007.1251 9.1249 390980.0000 5820007.1251 9.1249 390980.0000 5820003.0001 5.0624</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:RoofSurface>
</bldg:boundedBy>
<bldg:boundedBy>
<bldg:RoofSurface gml:id="roof_north">
<bldg:lod2MultiSurface>
<gml:MultiSurface gml:id="cm.house.m6">
<gml:surfaceMember>
<gml:Polygon gml:id="cm.house.p6">
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390990.5000 5820011.2501 5.0624 390980.0000 5820011.2501 5.0624 390980.0000 5820007.1251 9.1249 390990.5000 5820007.1251 9.1249 390990.5000 5820011.2501 5.0624</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:MultiSurface>
</bldg:lod2MultiSurface>
</bldg:RoofSurface>
</bldg:boundedBy>
<bldg:consistsOfBuildingPart>
<bldg:BuildingPart gml:id="annex">
<bldg:lod1Solid>
<gml:Solid gml:id="cm.annex.s0">
<gml:exterior>
<gml:CompositeSurface gml:id="cm.annex.k0">
<gml:surfaceMember>
<gml:Polygon gml:id="ground_2">
<gml:name>GroundSurface</gml:name>
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390995.0000 5820006.0000 0.0000 390998.0000 5820006.0000 0.0000 390998.0000 5820003.0000 0.0000 390995.0000 5820003.0000 0.0000 390995.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
<gml:surfaceMember>
<gml:Polygon gml:id="wall_0_2">
<gml:name>WallSurface</gml:name>
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390995.0000 5820003.0000 0.0000 390998.0000 5820003.0000 0.0000 390998.0000 5820003.0000 2.5000 390995.0000 5820003.0000 2.5000 390995.0000 5820003.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
<gml:surfaceMember>
<gml:Polygon gml:id="wall_1_2">
<gml:name>WallSurface</gml:name>
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390998.0000 5820003.0000 0.0000 390998.0000 5820006.0000 0.0000 390998.0000 5820006.0000 2.5000 390998.0000 5820003.0000 2.5000 390998.0000 5820003.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
<gml:surfaceMember>
<gml:Polygon gml:id="wall_2_2">
<gml:name>WallSurface</gml:name>
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390998.0000 5820006.0000 0.0000 390995.0000 5820006.0000 0.0000 390995.0000 5820006.0000 2.5000 390998.0000 5820006.0000 2.5000 390998.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
<gml:surfaceMember>
<gml:Polygon gml:id="wall_3_2">
<gml:name>WallSurface</gml:name>
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390995.0000 5820006.0000 0.0000 390995.0000 5820003.0000 0.0000 390995.0000 5820003.0000 2.5000 390995.0000 5820006.0000 2.5000 390995.0000 5820006.0000 0.0000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
<gml:surfaceMember>
<gml:Polygon gml:id="roof_2">
<gml:name>RoofSurface</gml:name>
<gml:exterior><gml:LinearRing><gml:posList srsDimension="3">390995.0000 5820003.0000 2.5000 390998.0000 5820003.0000 2.5000 390998.0000 5820006.0000 2.5000 390995.0000 5820006.0000 2.5000 390995.0000 5820003.0000 2.5000</gml:posList></gml:LinearRing></gml:exterior>
</gml:Polygon>
</gml:surfaceMember>
</gml:CompositeSurface>
</gml:exterior>
</gml:Solid>
</bldg:lod1Solid>
</bldg:BuildingPart>
</bldg:consistsOfBuildingPart>
</bldg:Building>
</cityObjectMember>
</CityModel>
